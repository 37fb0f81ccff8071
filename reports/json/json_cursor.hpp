// Typed access to a JSON document that a user gives (a baseline, states of a candidate), with the path
// of each value for error messages.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// A JSON document cannot be used. what() reads "FILE: scenes[0].branches[1].legs: missing".
struct ResultError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A value of a document; the document and the file's name have to outlive it.
struct JsonCursor {
    const nlohmann::ordered_json* value;
    std::string path;  // empty for the whole document
    const std::string* file;

    [[noreturn]] void fail(const std::string& what) const;

    // Fails unless this is an object with all of `required` and no other field but `optional`.
    void only_keys(std::initializer_list<std::string_view> required,
                   std::string_view optional = "") const;
    JsonCursor operator[](std::string_view key) const;                // must be there
    std::optional<JsonCursor> find(std::string_view key) const;       // empty when absent or null
    std::vector<std::pair<std::string, JsonCursor>> entries() const;  // of an object
    std::vector<JsonCursor> items() const;                            // of an array

    double number() const;  // NaN for null
    bool truth() const;
    std::string text() const;   // one line without control characters (escape.hpp: flaw)
    std::string lines() const;  // the same with line ends
    std::vector<double> numbers() const;
    std::vector<std::string> texts() const;
};

}  // namespace elastocheck::reports
