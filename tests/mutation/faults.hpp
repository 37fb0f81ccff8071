// Seeded faults: where each stands in the sources, and whether a test that fails on it is on record.
#pragma once

#include <nlohmann/json.hpp>
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
    std::string file;  // below the root
    Range expression, definition;
};

// From the text of faults.txt. Throws std::runtime_error that names the line.
std::vector<Fault> parse_faults(std::string_view text);

// The one place of the edit below `root`. Throws std::runtime_error that names the folder and the
// definition where there is none or more than one.
Place locate(const std::string& root, const Edit& edit);

// A hash of what a result depends on: the definitions that the fault changes, without comments and
// white space, and the changes.
std::string stamp(const std::string& root, const Fault& fault);

// Number of faults without a result: ./dev mutate runs them.
std::size_t never_run(const std::vector<Fault>& faults, const nlohmann::ordered_json& results);

// What `results`, an array of {fault, suite, first, stamp, ...}, leaves open: a fault without a
// result, one of another stamp or suite, one that survived, a result of no fault. And a fault
// without its place, or of a suite that is not among `suites`.
std::vector<std::string> problems(const std::string& root, const std::vector<Fault>& faults,
                                  const nlohmann::ordered_json& results,
                                  const std::vector<std::string>& suites);

std::string read_file(const std::string& file);
void write_file(const std::string& file, std::string_view text);

}  // namespace elastocheck::mutation
