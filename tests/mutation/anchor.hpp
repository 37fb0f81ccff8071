// Locates an expression inside a named definition of C++ source, whatever its formatting.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::mutation {

struct Range {
    std::size_t begin = 0, end = 0;  // characters of the text
};

// The definitions of `name` in `text`: functions (every overload), structs, named lambdas and
// initialised variables, from the name to the end of the body. Calls and declarations are none.
std::vector<Range> definitions(std::string_view text, std::string_view name);

// Where `expression` occurs inside `range` of `text`, compared without comments and white space.
// An identifier at either end of the expression matches whole identifiers only.
std::vector<Range> occurrences(std::string_view text, Range range, std::string_view expression);

}  // namespace elastocheck::mutation
