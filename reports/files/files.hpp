// Files are written whole or not at all, and read whole.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace elastocheck::reports {

// A file could not be written; what() names it and says why.
struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Writes `content` to a temporary name beside `file`, flushes it to the disk and renames it; creates the
// folder when it is missing. Throws FileError; an older file of that name is then untouched.
void write_whole(const std::filesystem::path& file, std::string_view content);

// The content of a file; throws FileError.
std::string read_whole(const std::filesystem::path& file);

}  // namespace elastocheck::reports
