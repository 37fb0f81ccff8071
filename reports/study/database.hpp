// A database of SQLite and its statements; the headers of SQLite are included in database.cpp only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace elastocheck::reports {

// Every function throws FileError with the message of SQLite, or with what a value is that is not of
// the expected type.
class Database {
  public:
    // Both may write, none a symbolic link: what a killed process left in a file is undone when it is opened.
    enum class Access { existing, create };
    Database(std::filesystem::path file, Access access);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    void run(const std::string& sql) const;
    [[noreturn]] void fail() const;
    const std::filesystem::path& file() const { return file_; }

  private:
    friend class Statement;
    std::filesystem::path file_;
    sqlite3* handle_ = nullptr;
};

// Pre: the database outlives it.
class Statement {
  public:
    Statement(const Database& database, const std::string& sql);
    ~Statement();
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    bool step();     // whether there is a row
    void execute();  // to be bound and executed again

    // Parameters from 1. NaN becomes NULL.
    void bind(int at, std::uint64_t value);
    void bind(int at, int value);
    void bind(int at, double value);
    void bind(int at, const std::string& value);
    void bind_nothing(int at);

    // Columns from 0. NULL is NaN, or an empty text; a column of another type is an error, which names
    // the row by its first column.
    std::uint64_t whole(int column) const;
    double number(int column) const;
    std::string text(int column) const;

  private:
    bool is_null(int column, int type, const char* expected) const;

    const Database& database_;
    sqlite3_stmt* handle_ = nullptr;
};

}  // namespace elastocheck::reports
