#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "models/import/chrono/suspension.hpp"
#include "models/reader/document/characters.hpp"

namespace elastocheck::importer::chrono {
namespace {

// Replaces comments, which JSON does not have, by blanks, and CR alone, which does not end a line in YAML,
// by LF. Lines keep their numbers.
std::string without_comments(std::string_view text) {
    std::string result(text);
    const auto at = [&](std::size_t k) { return k < text.size() ? text[k] : '\n'; };
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '"') {
            while (++k < text.size() && text[k] != '"') k += text[k] == '\\' ? 1 : 0;
        } else if (text[k] == '/') {
            const bool is_block = at(k + 1) == '*';
            const std::size_t end = is_block ? text.find("*/", k + 2) + 2
                                             : std::min(text.find_first_of("\r\n", k), text.size());
            for (; k < end; ++k)
                if (at(k) != '\n' && at(k) != '\r') result[k] = ' ';
            --k;
        }
    }
    if (text.find('\n') == text.npos) std::ranges::replace(result, '\r', '\n');
    return result;
}

// nlohmann's parser checks that the text is JSON. yaml-cpp, of whose language JSON is a part, then parses it
// with the line of each value.
reader::Value parse_json(std::string_view text, const std::string& file) {
    if (text.size() > largest_json)
        reader::fail(file, 0, "", "larger than 1 MiB, the limit for a suspension");
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.find('\0') != text.npos || !reader::is_utf8(text))
        reader::fail(file, 0, "", "not plain text (UTF-8): this is not JSON");
    constexpr bool ignore_comments = true;
    try {
        [[maybe_unused]] const auto valid =
            nlohmann::json::parse(text, nullptr, true, ignore_comments);
    } catch (const nlohmann::json::exception& error) {
        // "[...] parse error at line 3, column 5: what is wrong"
        std::string_view what = error.what();
        int line = 0;
        if (const auto at = what.find("line "); at != what.npos)
            std::from_chars(what.data() + at + 5, what.data() + what.size(), line);
        what.remove_prefix(what.find(": ") + 2);
        reader::fail(file, line, "", fmt::format("invalid JSON: {}", what));
    }
    return reader::parse_yaml(without_comments(text), file, reader::Syntax::json);
}

}  // namespace

JsonFile::JsonFile(std::string_view text, const std::string& file)
    : name(file), tree(parse_json(text, name)), root{&tree, "", &name, &numbers, {}, &accesses} {
    if (tree.kind != reader::Value::Kind::map)
        root.fail("expected an object: this is not a file of Chrono::Vehicle");
}

}  // namespace elastocheck::importer::chrono
