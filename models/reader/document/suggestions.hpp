// Words in error messages: quoting, and suggestion of the nearest allowed word.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reader {

// The text on one line, truncated if long; quote() adds quotation marks.
std::string shown(std::string_view text);
std::string quote(std::string_view text);

// "joints" + "ball_joint" = "joints.ball_joint"
std::string child_path(const std::string& path, std::string_view key);

// "a, b, c", truncated if long.
std::string listed(const std::vector<std::string>& words);

// Completes a message on a wrong word: ", did you mean 'spherical'? allowed: spherical, revolute",
// or "; allowed: ..." if no word is near. `label` is the word before the colon.
std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& right,
                         const char* label);

}  // namespace elastocheck::reader
