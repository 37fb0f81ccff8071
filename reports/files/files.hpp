// Atomic writing of files, which protects files of other programs, and reading with a size limit.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

#include "reports/files/limits.hpp"

namespace elastocheck::reports {

// A file cannot be read or written, or must not be; what() names it with the reason.
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Kind of an output file, recognised by the first characters of its content, white space ignored.
struct FileKind {
    std::string_view name, beginning;
};
inline constexpr FileKind curves_file{"curves", "branch,leg,parameter,unit,"};
inline constexpr FileKind rates_file{"rates", "branch,parameter,parameter unit,"};
inline constexpr FileKind gradients_file{"derivatives", "branch,parameter,unit,output,number,"};
inline constexpr FileKind loads_file{"loads", "case,imbalance,disagreement,"};
inline constexpr FileKind states_file{"states", R"({"branch":)"};
inline constexpr FileKind baseline_file{"baseline", R"({"schema": "elastocheck/baseline/)"};
inline constexpr FileKind junit_file{
    "JUnit report", R"(<?xml version="1.0" encoding="UTF-8"?><testsuites name="elastocheck gate")"};
inline constexpr FileKind summary_file{"gate summary", "# elastocheck gate: "};

// Throws FileError unless `file` does not exist or is a regular file that begins as its kind does,
// so that no device, link, folder or file of another program is replaced.
void check_may_write(const std::filesystem::path& file, const FileKind& kind);

// Temporary name ".NAME.elastocheck-PROCESS" beside a file or folder that is being written. Removes
// those that interrupted runs left there.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

// A file that is written in pieces under a temporary name beside its own, and renamed when it
// is complete. An unfinished file is removed by its owner; if a signal or a crash ended the
// owner, by the next run that writes this file. Throws FileError; an older file of that name
// is then untouched.
class AtomicFile {
  public:
    // check_may_write; creates the folder when it is missing.
    AtomicFile(std::filesystem::path file, const FileKind& kind);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    void add(std::string_view content);
    void finish();  // flushes it to the disk and renames it

  private:
    void write_buffer();

    const FileKind* kind_;                    // one of the constants above
    std::filesystem::path file_, temporary_;  // the latter is empty after the renaming
    std::string buffer_;                      // write buffer
    int out_ = -1;
};

// Writes a file at once.
void write_whole(const std::filesystem::path& file, std::string_view content, const FileKind& kind);

// Appends to an existing regular file. Throws FileError.
void append(const std::filesystem::path& file, std::string_view content);

// Writes a file in a staging folder (folder.hpp). Throws FileError.
void write_staged(const std::filesystem::path& file, std::string_view content);

// A file of the installed program or of its build tree: the first of the relative paths `places` that
// exists below the nearest folder above the running program that has one; empty if none has.
std::filesystem::path beside_program(std::initializer_list<std::string> places);

// Reads a file or a pipe; throws FileError, for a larger one as soon as it exceeds the limit.
std::string read_whole(const std::filesystem::path& file, std::size_t largest = largest_file);

}  // namespace elastocheck::reports
