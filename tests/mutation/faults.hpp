// Seeded faults, and where each stands in the sources.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/mutation/anchor.hpp"

namespace elastocheck::mutation {

// An expression of one definition, and what replaces it.
struct Edit {
    std::string folder;      // or file, below the root
    std::string definition;  // its name; empty: the whole file
    std::string find, make;
};

struct Fault {
    std::string name;
    std::string suite;   // the one that fails on it, "program.Suite" as in ctest
    std::string target;  // what that needs built, where it is not of a GoogleTest program
    std::string is;      // what it simulates
    std::vector<Edit> edits;
};

// Where an edit applies.
struct Place {
    std::string file;
    Range expression;
};

// From the text of faults.txt. Throws std::runtime_error that names the line.
std::vector<Fault> parse_faults(std::string_view text);

// The one place of the edit below `root`. Throws std::runtime_error that names the folder and the
// definition where there is none or more than one.
Place locate(const std::string& root, const Edit& edit);

std::string read_file(const std::string& file);
void write_file(const std::string& file, std::string_view text);

}  // namespace elastocheck::mutation
