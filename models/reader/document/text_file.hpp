// Reads text files for the readers of scenes and tables.
#pragma once

#include <filesystem>
#include <string>

#include "models/reader/document/limits.hpp"

namespace elastocheck::reader {

struct TextFile {
    std::string text;     // at most one byte more than `largest`, so that the caller can reject it
    std::string trouble;  // error message such as "no such file"; empty on success
};
// A scene may be read from a pipe. Files that a scene refers to and imported files must be regular:
// reading a pipe would block.
enum class Pipes { allowed, refused };
TextFile read_text(const std::filesystem::path& file, Pipes pipes,
                   std::size_t largest = largest_text);

// Whether a file is outside the folder once symbolic links are resolved. False for a path that cannot
// be resolved: it cannot be read either.
bool leads_out_of(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace elastocheck::reader
