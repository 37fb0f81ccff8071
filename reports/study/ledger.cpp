#include "reports/study/ledger.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/study/database.hpp"

namespace elastocheck::reports {
namespace {

using compare::variants::StudyFigure;
using compare::variants::VariantFigures;
using compare::variants::VariantOutcome;

constexpr const char* format = "elastocheck/ledger/2";
constexpr int method_series = 0, method_equilibrium = 1;  // as summary() counts them

// "f1, f2, ..." with something between.
std::string listed_figures(std::size_t count, const char* written = "f{}") {
    std::string list;
    for (std::size_t k = 1; k <= count; ++k)
        list += (k > 1 ? ", " : "") + fmt::format(fmt::runtime(written), k);
    return list;
}

std::string quoted_name(std::string name) {
    for (std::size_t at = 0; (at = name.find('"', at)) != name.npos; at += 2) name.insert(at, "\"");
    return '"' + name + '"';
}

std::string text_of_meta(const Database& database, const std::string& key) {
    Statement meta(database, "SELECT value FROM meta WHERE key = ?");
    meta.bind(1, key);
    return meta.step() ? meta.text(0) : "";
}

// Rows of several versions of the program are not added to each other.
void check_identity(const Database& database, const StudyIdentity& identity,
                    Ledger::Access access) {
    Statement tables(database,
                     "SELECT count(*) FROM sqlite_master WHERE name IN ('meta', 'variants')");
    if (!tables.step() || tables.whole(0) != 2 || text_of_meta(database, "format") != format)
        throw FileError(database.file().string() + ": not a ledger of a study");
    struct Part {
        const char *key, *what;
        const std::string& here;
    };
    for (const auto& [key, what, here] :
         {Part{"scene", "scene", identity.scene}, Part{"study", "study file", identity.study},
          Part{"version", "version of the program", identity.version}}) {
        const std::string there = text_of_meta(database, key);
        if (there == here || (&here == &identity.version && access == Ledger::Access::read))
            continue;
        throw FileError(
            fmt::format("{}: is of another {}: {} there, {} here; another {} needs another folder",
                        database.file().string(), what, there, here, what));
    }
}

void create(const Database& database, const StudyIdentity& identity,
            const std::vector<StudyFigure>& figures) {
    const std::string columns = fmt::format(
        "(k INTEGER PRIMARY KEY, outcome INTEGER NOT NULL, method INTEGER NOT NULL, reason TEXT, "
        "{}, checksum TEXT NOT NULL)",
        listed_figures(figures.size(), "f{} REAL"));
    database.run("BEGIN");
    database.run("CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT)");
    database.run("CREATE TABLE figures (f INTEGER PRIMARY KEY, name TEXT, unit TEXT, figure TEXT)");
    database.run("CREATE TABLE outcomes (outcome INTEGER PRIMARY KEY, name TEXT)");
    database.run("CREATE TABLE methods (method INTEGER PRIMARY KEY, name TEXT)");
    database.run("INSERT INTO methods VALUES (0, 'series'), (1, 'equilibrium')");
    database.run("CREATE TABLE variants " + columns);
    database.run("CREATE TABLE witnesses " + columns);
    Statement meta(database, "INSERT INTO meta VALUES (?, ?)");
    for (const auto& [key, value] :
         {std::pair("scene", identity.scene), std::pair("study", identity.study),
          std::pair("version", identity.version), std::pair("format", std::string(format))}) {
        meta.bind(1, std::string(key)), meta.bind(2, value);
        meta.execute();
    }
    Statement outcome(database, "INSERT INTO outcomes VALUES (?, ?)");
    for (int code = 0; code < compare::variants::variant_outcomes; ++code) {
        outcome.bind(1, code);
        outcome.bind(2, std::string(name(static_cast<VariantOutcome>(code))));
        outcome.execute();
    }
    Statement figure(database, "INSERT INTO figures VALUES (?, ?, ?, ?)");
    std::string named;
    for (std::size_t k = 0; k < figures.size(); ++k) {
        figure.bind(1, static_cast<std::uint64_t>(k + 1));
        figure.bind(2, figures[k].name);
        figure.bind(3, std::string(symbol(figures[k].unit)));
        figure.bind(4, figures[k].words);
        figure.execute();
        named += fmt::format(", f{} AS {}", k + 1, quoted_name(figures[k].name));
    }
    database.run(fmt::format(
        "CREATE VIEW results AS SELECT k, outcomes.name AS outcome, methods.name AS method, "
        "reason{} FROM variants JOIN outcomes USING (outcome) JOIN methods USING (method)",
        named));
    database.run("COMMIT");
}

enum LedgerColumn { at_k, at_outcome, at_method, at_reason, at_figures };

// What the checksum of a row and the hash of the content are made of.
void append_bytes(std::string& bytes, const LedgerRow& row) {
    const auto add = [&](const auto& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(row.k), add(static_cast<std::int32_t>(row.figures.outcome));
    add(static_cast<std::int32_t>(row.figures.leg));
    bytes += row.figures.reason;
    bytes += '\0';
    for (const double value : row.figures.values)
        std::isnan(value) ? add(std::uint64_t{0x7ff8} << 48) : add(value);
}
std::string checksum(const LedgerRow& row) {
    std::string bytes;
    append_bytes(bytes, row);
    return input_hash(bytes);
}

void bind_row(Statement& insert, const LedgerRow& row) {
    const VariantFigures& figures = row.figures;
    insert.bind(1 + at_k, row.k);
    insert.bind(1 + at_outcome, static_cast<int>(figures.outcome));
    insert.bind(1 + at_method,
                figures.leg == compare::Leg::series ? method_series : method_equilibrium);
    if (figures.reason.empty())
        insert.bind_nothing(1 + at_reason);
    else
        insert.bind(1 + at_reason, figures.reason);
    int at = 1 + at_figures;
    for (const double value : figures.values) insert.bind(at++, value);
    insert.bind(at, checksum(row));
}

// Of a row as Ledger::State::selected().
LedgerRow row_of(const Statement& row, std::size_t figures, const Database& database) {
    LedgerRow result{.k = row.whole(at_k), .figures = {}};
    const std::uint64_t outcome = row.whole(at_outcome), method = row.whole(at_method);
    result.figures.outcome = static_cast<VariantOutcome>(outcome);
    result.figures.leg = method == method_series ? compare::Leg::series : compare::Leg::equilibrium;
    result.figures.reason = row.text(at_reason);
    int at = at_figures;
    for (; at < at_figures + static_cast<int>(figures); ++at)
        result.figures.values.push_back(row.number(at));
    if (outcome >= compare::variants::variant_outcomes || method > method_equilibrium ||
        row.text(at) != checksum(result))
        throw FileError(fmt::format(
            "{}: row {}: its content is not that of its checksum: the file is damaged or was "
            "edited; `sqlite3 FILE 'DELETE FROM variants WHERE k = {}'` has it computed again",
            database.file().string(), result.k, result.k));
    return result;
}

}  // namespace

struct Ledger::State {
    State(const std::filesystem::path& file, std::size_t count, StudyIdentity of,
          Database::Access access)
        : database(file, access), figures(count), identity(std::move(of)) {}

    Database database;
    std::size_t figures;
    StudyIdentity identity;

    // The rows of a table of which the condition holds, in their order.
    Statement rows(const char* table, const std::string& where) const {
        return {database, fmt::format("SELECT k, outcome, method, reason, {}, checksum FROM {} "
                                      "WHERE {} ORDER BY k",
                                      listed_figures(figures), table, where)};
    }
    LedgerRow row(const Statement& statement) const { return row_of(statement, figures, database); }
};

Ledger::Ledger(const std::filesystem::path& file, const StudyIdentity& identity,
               const std::vector<StudyFigure>& figures, Access access) {
    if (access != Access::write && !std::filesystem::exists(file))
        throw FileError(file.string() + ": no such ledger; nothing has been computed");
    state_ = std::make_unique<State>(
        file, figures.size(), identity,
        access == Access::write ? Database::Access::create : Database::Access::existing);
    const Database& database = state_->database;
    bool is_empty = false;
    {
        Statement tables(database, "SELECT count(*) FROM sqlite_master");
        is_empty = tables.step() && tables.whole(0) == 0;
    }
    if (access == Access::write && is_empty) create(database, identity, figures);
    check_identity(database, identity, access);
    for (const char* table : {"variants", "witnesses"})
        for (Statement found = state_->rows(table, "true"); found.step();) (void)state_->row(found);
}
Ledger::~Ledger() = default;

const std::filesystem::path& Ledger::file() const { return state_->database.file(); }

void Ledger::add(std::span<const LedgerRow> rows) {
    const Database& database = state_->database;
    const std::string values =
        fmt::format(" VALUES (?, ?, ?, ?, {}, ?)", listed_figures(state_->figures, "?"));
    database.run("BEGIN IMMEDIATE");
    {
        Statement variant(database, "INSERT INTO variants" + values);
        Statement witness(database, "INSERT INTO witnesses" + values);
        for (const LedgerRow& row : rows) {
            bind_row(variant, row);
            variant.execute();
            for (const VariantFigures& reference : row.witness) {
                bind_row(witness, {row.k, reference});
                witness.execute();
            }
        }
    }
    database.run("COMMIT");
}

void Ledger::merge(const Ledger& other) {
    const Database& database = state_->database;
    Statement attach(database, "ATTACH ? AS other");
    attach.bind(1, other.file().string());
    attach.execute();
    for (const char* table : {"variants", "witnesses"}) {
        Statement conflict(database, fmt::format("SELECT k FROM other.{0} o JOIN main.{0} m USING "
                                                 "(k) WHERE o.checksum != m.checksum LIMIT 1",
                                                 table));
        if (conflict.step())
            throw FileError(fmt::format("{}: variant {} has other values than in {}",
                                        other.file().string(), conflict.whole(0),
                                        database.file().string()));
    }
    database.run("BEGIN IMMEDIATE");
    for (const char* table : {"variants", "witnesses"})
        database.run(fmt::format("INSERT OR IGNORE INTO main.{0} SELECT * FROM other.{0}", table));
    database.run("COMMIT");
    database.run("DETACH other");
}

std::vector<std::uint64_t> Ledger::rows_by_batch(std::uint64_t size, std::uint64_t count) const {
    std::vector<std::uint64_t> rows((count + size - 1) / size, 0);
    Statement batches(state_->database,
                      "SELECT k / ?1, count(*) FROM variants WHERE k < ?2 GROUP BY k / ?1");
    batches.bind(1, size), batches.bind(2, count);
    while (batches.step()) rows[batches.whole(0)] = batches.whole(1);
    return rows;
}

std::set<std::uint64_t> Ledger::rows_in(std::uint64_t first, std::uint64_t end) const {
    Statement found(state_->database, "SELECT k FROM variants WHERE k >= ? AND k < ?");
    found.bind(1, first), found.bind(2, end);
    std::set<std::uint64_t> rows;
    while (found.step()) rows.insert(found.whole(0));
    return rows;
}

LedgerSummary Ledger::summary(std::uint64_t count) const {
    LedgerSummary summary{.by_outcome =
                              std::vector<std::uint64_t>(compare::variants::variant_outcomes, 0)};
    Statement found(state_->database,
                    "SELECT outcome, count(*), total(method) FROM variants WHERE k < ? GROUP BY "
                    "outcome");
    found.bind(1, count);
    while (found.step()) {
        summary.by_outcome.at(found.whole(0)) = found.whole(1);
        summary.rows += found.whole(1);
        summary.by_equilibrium += static_cast<std::uint64_t>(found.number(2));
    }
    return summary;
}

std::vector<double> Ledger::values(std::size_t figure, std::uint64_t count) const {
    std::vector<double> values(count, std::numeric_limits<double>::quiet_NaN());
    Statement found(state_->database,
                    fmt::format("SELECT k, f{} FROM variants WHERE k < ?", figure + 1));
    found.bind(1, count);
    while (found.step()) values[found.whole(0)] = found.number(1);
    return values;
}

std::vector<WitnessDifference> Ledger::witnesses(std::uint64_t count) const {
    std::vector<WitnessDifference> all(state_->figures);
    Statement found(
        state_->database,
        fmt::format("SELECT v.k, {}, {} FROM witnesses w JOIN variants v USING (k) WHERE k < ? "
                    "ORDER BY k",
                    listed_figures(all.size(), "v.f{}"), listed_figures(all.size(), "w.f{}")));
    found.bind(1, count);
    while (found.step())
        for (std::size_t j = 0; j < all.size(); ++j) {
            const double value = found.number(static_cast<int>(1 + j)),
                         reference = found.number(static_cast<int>(1 + all.size() + j));
            WitnessDifference& of = all[j];
            if (!std::isfinite(value) && !std::isfinite(reference)) continue;
            if (!std::isfinite(value) || !std::isfinite(reference)) {
                ++of.one_sided;
                continue;
            }
            ++of.count;
            if (std::abs(value - reference) > of.largest)
                of.largest = std::abs(value - reference), of.at = found.whole(0);
        }
    return all;
}

std::vector<LedgerRow> Ledger::failed(std::uint64_t count, std::size_t most) const {
    Statement found = state_->rows("variants", "outcome != 0 AND k < ?");
    found.bind(1, count);
    std::vector<LedgerRow> rows;
    while (rows.size() < most && found.step()) rows.push_back(state_->row(found));
    return rows;
}

void Ledger::each_row(std::uint64_t count,
                      const std::function<void(const LedgerRow&)>& visit) const {
    Statement found = state_->rows("variants", "k < ?");
    found.bind(1, count);
    while (found.step()) visit(state_->row(found));
}

std::string Ledger::content_hash(std::uint64_t count) const {
    constexpr std::size_t at_once = std::size_t{1} << 20;
    std::string bytes;
    for (const char* table : {"variants", "witnesses"}) {
        Statement found = state_->rows(table, "k < ?");
        found.bind(1, count);
        while (found.step()) {
            append_bytes(bytes, state_->row(found));
            if (bytes.size() > at_once) bytes = input_hash(bytes);
        }
        bytes = input_hash(bytes);
    }
    return bytes;
}

LedgerLock::LedgerLock(const std::filesystem::path& ledger) {
    // Beside the ledger: SQLite loses its own locks where the file itself is opened once more.
    const std::string file = ledger.string() + ".lock";
    file_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0)
        throw FileError(fmt::format("{}: cannot be written: {}", file, std::strerror(errno)));
    if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(file_);
    throw FileError(ledger.string() + ": another process is computing this study here");
}
LedgerLock::~LedgerLock() { ::close(file_); }

}  // namespace elastocheck::reports
