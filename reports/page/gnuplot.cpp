#include "reports/page/gnuplot.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstring>
#include <limits>

#include "reports/files/subprocess.hpp"

namespace elastocheck::reports {

void run_gnuplot(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"gnuplot"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    constexpr double no_limit = std::numeric_limits<double>::infinity();
    Ended ended = run(words, no_limit, folder.string());
    if (ended.well()) return;
    if (ended.how == Ended::How::not_started)
        throw PlotError(
            fmt::format("gnuplot cannot be run ({}); figures need it: install gnuplot-nox",
                        std::strerror(ended.code)));
    std::string& said = ended.said;
    while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back())) != 0)
        said.pop_back();
    throw PlotError(fmt::format("gnuplot {}: {}", arguments.empty() ? "" : arguments.back(),
                                said.empty() ? describe(ended, no_limit) : said));
}

}  // namespace elastocheck::reports
