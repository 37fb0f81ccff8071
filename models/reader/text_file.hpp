// Text files as they come, for the readers of scenes and tables.
#pragma once

#include <filesystem>
#include <string>

#include "models/reader/limits.hpp"

namespace elastocheck::reader {

struct TextFile {
    std::string text;     // one byte more than the largest at most: for the reader to refuse
    std::string trouble;  // why there is none: "no such file"; empty where there is
};
TextFile read_text(const std::filesystem::path& file, std::size_t largest = largest_text);

}  // namespace elastocheck::reader
