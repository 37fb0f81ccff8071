#include "models/reader/text_file.hpp"

#include <fstream>
#include <system_error>

namespace elastocheck::reader {

TextFile read_text(const std::filesystem::path& file) {
    std::error_code ignored;
    const auto status = std::filesystem::status(file, ignored);
    if (status.type() == std::filesystem::file_type::not_found) return {"", "no such file"};
    if (is_directory(status)) return {"", "a directory; a file is needed"};
    std::ifstream stream(file, std::ios::binary);
    std::string text(largest_text + 1, '\0');
    if (stream) stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream && !stream.eof()) return {"", "cannot be read"};
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return {text, ""};
}

}  // namespace elastocheck::reader
