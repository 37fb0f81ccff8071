// Files are written whole or not at all, never over what is not ours, and read whole.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "reports/files/limits.hpp"

namespace elastocheck::reports {

// A file could not be read or written, or must not be; what() names it and says why.
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A kind of file that the command writes where the user says, and how one of its own is told: by how it
// begins, white space apart.
struct FileKind {
    std::string_view name, beginning;
};
inline constexpr FileKind curves_file{"curves", "branch,leg,parameter,unit,"};
inline constexpr FileKind rates_file{"rates", "branch,parameter,parameter unit,"};
inline constexpr FileKind states_file{"states", R"({"branch":)"};
inline constexpr FileKind baseline_file{"baseline", R"({"schema": "elastocheck/baseline/)"};
inline constexpr FileKind junit_file{
    "JUnit report", R"(<?xml version="1.0" encoding="UTF-8"?><testsuites name="elastocheck gate")"};
inline constexpr FileKind summary_file{"gate summary", "# elastocheck gate: "};

// Throws FileError unless there is nothing at `file`, or a regular file that begins as its kind does: no
// device, no link, no folder, nothing that somebody else wrote.
void check_may_write(const std::filesystem::path& file, const FileKind& kind);

// A file that is written piece by piece, and is there once it is whole: until then it has a temporary name beside its
// own, and what is not finished is removed: by its owner, or by the next that writes the file where the owner was killed.
// Throws FileError; an older file of that name is then untouched.
class FileToBe {
  public:
    // check_may_write; creates the folder when it is missing.
    FileToBe(std::filesystem::path file, const FileKind& kind);
    FileToBe(const FileToBe&) = delete;
    FileToBe& operator=(const FileToBe&) = delete;
    ~FileToBe();

    void add(std::string_view content);
    void finish();  // flushes it to the disk and renames it

  private:
    [[noreturn]] void give_up(int error);
    void write_waiting();

    const FileKind* kind_;  // outlives it: one of those above
    std::filesystem::path file_, temporary_;
    std::string waiting_;  // to be written together
    int out_ = -1;
};

// The whole of it at once.
void write_whole(const std::filesystem::path& file, std::string_view content, const FileKind& kind);

// Adds to a regular file that is there already. Throws FileError.
void append(const std::filesystem::path& file, std::string_view content);

// Writes a file in a folder that nobody else knows of yet (folder.hpp). Throws FileError.
void fill(const std::filesystem::path& file, std::string_view content);

// The content of a file or a pipe; throws FileError, of what is larger as soon as it shows.
std::string read_whole(const std::filesystem::path& file, std::size_t largest = largest_file);

}  // namespace elastocheck::reports
