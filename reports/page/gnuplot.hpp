// Running gnuplot.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace elastocheck::reports {

// gnuplot is missing or refused a script; what() says which and what it said.
struct PlotError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Runs `gnuplot ARGUMENTS...` in `folder`, without a shell. Throws PlotError.
void run_gnuplot(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

}  // namespace elastocheck::reports
