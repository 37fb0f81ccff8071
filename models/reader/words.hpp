// Words of a scene file in messages: quoting, and the nearest of the right ones.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::reader {

// The text on one line and not too long, and the same between quotes.
std::string shown(std::string_view text);
std::string quote(std::string_view text);

// "joints" + "ball_joint" = "joints.ball_joint"
std::string child_path(const std::string& path, std::string_view key);

// "a, b, c", cut short when there are very many.
std::string listed(const std::vector<std::string>& words);

// What to say after a wrong word: ", did you mean 'spherical'? allowed: spherical, revolute", or "; allowed:
// ..." when nothing is near. `label` is the word before the colon.
std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& right, const char* label);

}  // namespace elastocheck::reader
