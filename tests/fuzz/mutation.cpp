#include "tests/fuzz/mutation.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/support/escapes.hpp"

namespace elastocheck::fuzz {
namespace {

using json = nlohmann::ordered_json;

// What one would write to do harm: numbers at the ends of their range, other languages' signs,
// names of others; one a line.
std::string_view word(Dice& dice) {
    static const std::vector<std::string> words = [] {
        std::vector<std::string> all;
        std::ifstream file(std::filesystem::path(ELASTOCHECK_CORPUS).parent_path() / "words.txt");
        for (std::string line; std::getline(file, line);) all.push_back(support::unescaped(line));
        return all;
    }();
    return words.at(dice.below(words.size()));
}

void change_bytes(std::string& text, Dice& dice) {
    const std::size_t at = dice.below(text.size() + 1);
    switch (dice.below(4)) {
        case 0: text.insert(at, 1, static_cast<char>(dice.below(256))); break;
        case 1: text.erase(at, 1 + dice.below(8)); break;
        case 2: text.resize(at); break;
        default:
            if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << dice.below(8)));
    }
}

// ---- Text in lines: a line goes, comes twice, or changes places; a word becomes another of the text, or a bad one.

bool is_of_word(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '.' || c == '-' || c == '+';
}

struct Piece {
    std::size_t begin = 0, length = 0;
};

template <class Of>
std::vector<Piece> pieces(std::string_view text, Of of) {
    std::vector<Piece> all;
    for (std::size_t k = 0; k < text.size();) {
        const std::size_t begin = k;
        while (k < text.size() && of(text[k])) ++k;
        if (k > begin) all.push_back({begin, k - begin});
        k += k < text.size();
    }
    return all;
}

void change_lines(std::string& text, Dice& dice) {
    const auto all = pieces(text, [](char c) { return c != '\n'; });
    if (all.empty()) return;
    const Piece one = all[dice.below(all.size())], other = all[dice.below(all.size())];
    const std::string line = text.substr(one.begin, one.length);
    if (dice.below(2) == 0)
        text.erase(one.begin, one.length);
    else
        text.insert(other.begin, line + "\n");
}

void change_word(std::string& text, Dice& dice) {
    const auto all = pieces(text, is_of_word);
    if (all.empty()) return;
    const Piece one = all[dice.below(all.size())], other = all[dice.below(all.size())];
    const std::string by(
        dice.below(2) == 0 ? word(dice) : std::string_view(text).substr(other.begin, other.length));
    text.replace(one.begin, one.length, by);
}

// ---- JSON: a node goes, comes twice, becomes another of the document, or something bad.

void collect(json& value, std::vector<json*>& nodes) {
    nodes.push_back(&value);
    if (value.is_structured())
        for (auto& entry : value) collect(entry, nodes);
}

json bad_value(Dice& dice) {
    switch (dice.below(6)) {
        case 0: return nullptr;
        case 1: return json::array();
        case 2: return json::object();
        case 3:
            return dice.below(2) == 0 ? json(-1e300)
                                      : json(static_cast<double>(dice.roll()) / 1e19);
        case 4: return dice.below(2) == 0;
        default: return std::string(word(dice));
    }
}

void change_tree(json& root, Dice& dice) {
    std::vector<json*> nodes;
    collect(root, nodes);
    json& node = *nodes[dice.below(nodes.size())];
    const json other = *nodes[dice.below(nodes.size())];
    switch (dice.below(5)) {
        case 0: node = bad_value(dice); break;
        case 1: node = other; break;
        case 2:
            if (node.is_structured() && !node.empty()) {
                const auto at =
                    std::next(node.begin(), static_cast<std::ptrdiff_t>(dice.below(node.size())));
                node.erase(at);
            }
            break;
        case 3:
            if (node.is_array())
                node.push_back(node.empty() ? other : node[dice.below(node.size())]);
            if (node.is_object()) node[std::string(word(dice))] = other;
            break;
        default:
            if (node.is_number())
                node = node.get<double>() * (dice.below(2) == 0 ? -1e10 : 1e-200);
            else if (node.is_string())
                node = node.get<std::string>() + std::string(word(dice));
    }
}

}  // namespace

std::uint64_t Dice::roll() {
    std::uint64_t z = state += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111eb;
    return z ^ (z >> 31U);
}

std::string mutated(const Target& target, std::string_view input, Dice& dice) {
    std::string text(input);
    const std::size_t changes = 1 + dice.below(4);
    if (target.is_json && dice.below(4) != 0) {
        json root = json::parse(text, nullptr, false);
        if (!root.is_discarded()) {
            for (std::size_t k = 0; k < changes; ++k) change_tree(root, dice);
            return root.dump(-1, ' ', false, json::error_handler_t::ignore);
        }
    }
    for (std::size_t k = 0; k < changes; ++k) switch (dice.below(5)) {
            case 0: change_bytes(text, dice); break;
            case 1: change_lines(text, dice); break;
            default: change_word(text, dice);
        }
    return text;
}

}  // namespace elastocheck::fuzz
