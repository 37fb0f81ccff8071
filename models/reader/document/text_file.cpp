#include "models/reader/document/text_file.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace elastocheck::reader {

TextFile read_text(const std::filesystem::path& file, Pipes pipes, std::size_t largest) {
    std::error_code ignored;
    const auto status = std::filesystem::status(file, ignored);
    if (status.type() == std::filesystem::file_type::not_found) return {"", "no such file"};
    if (is_directory(status)) return {"", "a directory; a file is needed"};
    if (pipes == Pipes::refused && exists(status) && !is_regular_file(status))
        return {"", "a pipe or a device; a regular file is needed"};
    std::ifstream stream(file, std::ios::binary);
    const auto size = std::filesystem::file_size(file, ignored);  // undefined for a pipe
    std::string text((ignored ? largest : std::min<std::size_t>(size, largest)) + 1, '\0');
    if (stream) stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream && !stream.eof()) return {"", "cannot be read"};
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return {text, ""};
}

bool leads_out_of(const std::filesystem::path& folder, const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code unknown;
    const fs::path inside = fs::canonical(folder.empty() ? "." : folder, unknown),
                   target = fs::weakly_canonical(fs::absolute(file), unknown);
    return !unknown && std::ranges::mismatch(inside, target).in1 != inside.end();
}

}  // namespace elastocheck::reader
