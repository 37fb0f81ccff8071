// Words of sentences and headings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reports {

// "a", "a and b", "a, b and c"
std::string enumerated(const std::vector<std::string>& words);

// "1 number", "2 numbers"
std::string counted(std::size_t count, const std::string& noun);

// A name as words: "wheel centre" of "wheel_centre".
std::string as_words(std::string name);

// Words in lower case, separated by all characters but Latin letters and digits.
std::vector<std::string> lower_words(std::string_view text);

}  // namespace elastocheck::reports
