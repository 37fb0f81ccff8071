// How far apart the baselines of several builds are, by unit: what the cross-build tolerances rest on.
//
//   class_table FOLDER...   of baselines, the first is what the others are compared with
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "reports/gate/baseline.hpp"

namespace {

using namespace elastocheck;
namespace fs = std::filesystem;

struct Worst {
    double difference = 0;
    std::string where;
};

// A counter's difference is its share of the accepted number.
std::map<std::string, Worst> worst_of(const fs::path& accepted, const fs::path& other) {
    std::map<std::string, Worst> worst;
    for (const auto& entry : fs::directory_iterator(accepted)) {
        if (entry.is_directory()) continue;
        const auto leaf = entry.path().filename();
        const auto a = reports::read_baseline(entry.path()).baseline.accepted;
        const auto b = reports::read_baseline(other / leaf).baseline.accepted;
        for (std::size_t s = 0; s < a.series.size(); ++s) {
            const auto &was = a.series[s], &is = b.series.at(s);
            if (was.channel != is.channel || was.branch != is.branch || was.quantity != is.quantity)
                throw std::runtime_error(leaf.string() + ": not the same series");
            for (std::size_t k = 0; k < was.values.size(); ++k) {
                double difference = std::abs(is.values.at(k) - was.values[k]);
                if (was.unit == "count") difference /= std::max(1.0, std::abs(was.values[k]));
                auto& of_unit = worst[was.unit];
                if (difference <= of_unit.difference) continue;
                of_unit = {difference, fmt::format("{} {} {}: {}", leaf.stem().string(), was.branch,
                                                   name(was.quantity), was.channel)};
            }
        }
    }
    return worst;
}

}  // namespace

int main(int argc, char** argv) {
    fmt::print("| build, from {} | unit | worst difference | where |\n|---|---|--:|---|\n",
               argc > 1 ? fs::path(argv[1]).parent_path().filename().string() : "");
    for (int k = 2; k < argc; ++k)
        for (const auto& [unit, worst] : worst_of(argv[1], argv[k]))
            fmt::print("| {} | {} | {:.2g} | {} |\n",
                       fs::path(argv[k]).parent_path().filename().string(), unit, worst.difference,
                       worst.where);
    return argc > 2 ? 0 : 2;
}
