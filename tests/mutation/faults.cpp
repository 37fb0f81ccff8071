#include "tests/mutation/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace elastocheck::mutation {

namespace fs = std::filesystem;

namespace {

// Files to search for a definition: the one file, or the C++ sources below the folder.
std::vector<fs::path> files_of(const fs::path& folder) {
    if (!fs::is_directory(folder)) return {folder};
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp")
            files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    return begin == text.npos ? "" : text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

}  // namespace

std::vector<Fault> parse_faults(std::string_view text) {
    std::vector<Fault> faults;
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (trimmed(line).empty() || line.front() == '#') continue;
        const std::size_t space = std::min(line.find(' '), line.size());
        const std::string key(line.substr(0, space));
        const std::string value(trimmed(line.substr(space)));
        const auto refuse = [&](std::string_view why) {
            throw std::runtime_error(fmt::format("faults.txt:{}: '{}' {}", number, key, why));
        };
        if (key == "fault") {
            if (std::ranges::count(faults, value, &Fault::name)) refuse("is listed twice");
            faults.push_back({.name = value, .suite = {}, .target = {}, .is = {}, .edits = {}});
            continue;
        }
        if (faults.empty()) refuse("stands before the first fault");
        Fault& fault = faults.back();
        if (key == "suite") {
            fault.suite = value;
        } else if (key == "target") {
            fault.target = value;
        } else if (key == "is") {
            fault.is = value;
        } else if (key == "in") {
            const std::size_t gap = std::min(value.find(' '), value.size());
            fault.edits.push_back({value.substr(0, gap),
                                   std::string(trimmed(std::string_view(value).substr(gap))), "",
                                   ""});
        } else if (fault.edits.empty()) {
            refuse("stands before the first 'in' of its fault");
        } else if (key == "find") {
            fault.edits.back().find = value;
        } else if (key == "make") {
            fault.edits.back().make = value;
        } else {
            refuse("is none of fault, suite, target, in, find, make, is");
        }
    }
    return faults;
}

Place locate(const std::string& root, const Edit& edit) {
    std::vector<Place> places;
    std::size_t defined = 0;
    for (const fs::path& file : files_of(fs::path(root) / edit.folder)) {
        const std::string text = read_file(file.string());
        if (text.find(edit.definition) == text.npos) continue;
        const auto ranges = edit.definition.empty() ? std::vector<Range>{{0, text.size()}}
                                                    : definitions(text, edit.definition);
        defined += ranges.size();
        for (const Range& range : ranges)
            for (const Range& found : occurrences(text, range, edit.find)) {
                const bool is_known = !places.empty() && places.back().file == file &&
                                      places.back().expression.begin == found.begin;
                if (!is_known) places.push_back({file.string(), found});
            }
    }
    const std::string name = edit.definition.empty() ? "the file" : edit.definition;
    if (defined == 0)
        throw std::runtime_error(fmt::format("{}: no definition of {}", edit.folder, name));
    if (places.size() != 1)
        throw std::runtime_error(fmt::format("{}: '{}' occurs {} times in {}, not once",
                                             edit.folder, edit.find, places.size(), name));
    return places.front();
}

std::string read_file(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw std::runtime_error(fmt::format("{}: cannot be read", file));
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const std::string& file, std::string_view text) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream) throw std::runtime_error(fmt::format("{}: cannot be written", file));
}

}  // namespace elastocheck::mutation
