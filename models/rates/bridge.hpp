// What passes between the two compilations of the reader: scenes and models as lists of plain data.
//
// This file and fields.hpp are the only ones that both read. Its namespace is the one that the
// second compilation is renamed to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace elastocheck_dual {

inline constexpr std::size_t directions = 8;  // of one pass

// A scene or a model: all its data in the order of fields.hpp.
struct Archive {
    std::vector<std::string> texts;    // names
    std::vector<std::int64_t> wholes;  // sizes, alternatives, bodies, whole numbers
    std::vector<double> values;
    std::vector<std::array<double, directions>> rates;  // of the values; or empty: all zero
};

using Flags = std::array<bool, directions>;

struct Answer {
    std::string error;  // what the reader threw; then there is nothing else
    Archive scene, model;
    Flags tie{};           // of each direction: some comparison was decided at a tie
    Flags whole_number{};  // of each change: one of its numbers is a whole number
};

struct File {
    std::string text, name;
    std::optional<std::string> folder;
    std::vector<std::pair<std::string, std::string>> settings;
};

// Numbers of the file, by their paths, that all change by the same amount.
using Together = std::vector<std::string>;

// The scene of the file and its model, with their derivatives by at most `directions` changes.
// `side`: 0, or ±1 for one change, as in dual.hpp.
Answer read(const File& file, bool everything, const std::vector<Together>& changes, int side);

// The model of the scene, with the derivative in direction 0 from that of the scene.
Answer compile(const Archive& scene, bool everything, int side);

}  // namespace elastocheck_dual
