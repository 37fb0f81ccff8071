#include "reports/study/database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <limits>
#include <utility>

#include "reports/files/files.hpp"

namespace elastocheck::reports {

Database::Database(std::filesystem::path file, Access access) : file_(std::move(file)) {
    if (std::error_code ignored; std::filesystem::is_symlink(file_, ignored))
        throw FileError(file_.string() + ": is a symbolic link; a ledger is a regular file");
    const int flags = SQLITE_OPEN_READWRITE | (access == Access::create ? SQLITE_OPEN_CREATE : 0);
    if (sqlite3_open_v2(file_.c_str(), &handle_, flags, nullptr) != SQLITE_OK) {
        const std::string why = sqlite3_errmsg(handle_);
        sqlite3_close(handle_);
        throw FileError(fmt::format("{}: {}", file_.string(), why));
    }
    constexpr int patience = 10'000;  // [ms], for a reader that holds it
    sqlite3_busy_timeout(handle_, patience);
}
Database::~Database() { sqlite3_close(handle_); }

void Database::fail() const {
    throw FileError(fmt::format("{}: {}", file_.string(), sqlite3_errmsg(handle_)));
}

void Database::run(const std::string& sql) const {
    if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

Statement::Statement(const Database& database, const std::string& sql) : database_(database) {
    if (sqlite3_prepare_v2(database.handle_, sql.c_str(), -1, &handle_, nullptr) != SQLITE_OK)
        database.fail();
}
Statement::~Statement() { sqlite3_finalize(handle_); }

bool Statement::step() {
    const int code = sqlite3_step(handle_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail();
    return code == SQLITE_ROW;
}
void Statement::execute() {
    step();
    sqlite3_reset(handle_);
}

void Statement::bind(int at, std::uint64_t value) {
    sqlite3_bind_int64(handle_, at, static_cast<sqlite3_int64>(value));
}
void Statement::bind(int at, int value) { sqlite3_bind_int(handle_, at, value); }
void Statement::bind(int at, double value) { sqlite3_bind_double(handle_, at, value); }
void Statement::bind(int at, const std::string& value) {
    sqlite3_bind_text(handle_, at, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
}
void Statement::bind_nothing(int at) { sqlite3_bind_null(handle_, at); }

bool Statement::is_null(int column, int type, const char* expected) const {
    const int found = sqlite3_column_type(handle_, column);
    if (found == type || found == SQLITE_NULL) return found == SQLITE_NULL;
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
    throw FileError(fmt::format("{}: row {}: {} is '{}'; expected {}", database_.file().string(),
                                sqlite3_column_int64(handle_, 0),
                                sqlite3_column_name(handle_, column), text == nullptr ? "" : text,
                                expected));
}
std::uint64_t Statement::whole(int column) const {
    return is_null(column, SQLITE_INTEGER, "a whole number")
               ? 0
               : static_cast<std::uint64_t>(sqlite3_column_int64(handle_, column));
}
double Statement::number(int column) const {
    return is_null(column, SQLITE_FLOAT, "a number") ? std::numeric_limits<double>::quiet_NaN()
                                                     : sqlite3_column_double(handle_, column);
}
std::string Statement::text(int column) const {
    return is_null(column, SQLITE_TEXT, "a text")
               ? ""
               : reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
}

}  // namespace elastocheck::reports
