// Inputs made from others, for targets whose format a change of single bytes hardly ever survives.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {

// The same numbers everywhere (SplitMix64): the standard's distributions differ from library to library.
struct Dice {
    std::uint64_t state;
    std::uint64_t roll();
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(roll() % n); }  // Pre: n > 0
};

// One to four changes: of a line or a word where the format is lines, of a node of the tree where it is JSON, now and
// then of bytes.
std::string mutated(const Target& target, std::string_view input, Dice& dice);

}  // namespace elastocheck::fuzz
