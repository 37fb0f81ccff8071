// Runs gnuplot.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace elastocheck::reports {

// gnuplot is missing or rejected a script; what() names the script and contains gnuplot's message.
struct PlotError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Runs `gnuplot ARGUMENTS...` in `folder`, without a shell. Throws PlotError.
void run_gnuplot(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

}  // namespace elastocheck::reports
