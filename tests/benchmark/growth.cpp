// How the cost of a scene grows with its bodies: growth [-o DIR] writes growth.csv and figures/growth-FAMILY.svg there, and
// prints a table.
//
// A cost is that of the whole command, reading and writing included: CPU seconds, user and system, of `elastocheck solve
// --method METHOD` (or `elastocheck inspect`) on a family of one branch and five steps, the least of some runs; and the most memory it
// had at a time. From both goes what the same command takes for a scene of one body, its start. The exponent is the slope of
// least squares of the logarithm of what is left over that of the bodies, of the three largest sizes.
//
// A method that is foretold to need more than the budget for the next size, by the exponent between its last two sizes (by a cube
// where there is but one), is not asked from there on; and none may use up twice the budget. Both are said, and so is an
// exit code other than 0, whose cost is no part of the exponent.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "reports/page/plot.hpp"
#include "tests/benchmark/families.hpp"

namespace {

using namespace elastocheck;
using families::Family;
using families::Hinge;
using families::Kind;

const std::vector<Family> all_families{{Kind::chain},       {Kind::chain, 0, Hinge::revolute},
                                       {Kind::tree},        {Kind::tree, 0, Hinge::revolute},
                                       {Kind::grid},        {Kind::grid, 0, Hinge::revolute},
                                       {Kind::leaf_spring}, {Kind::ladder_frame},
                                       {Kind::axle}};
const std::vector<std::string> methods{"published", "series", "equilibrium", "energy", "inspect"};

std::string title(const Family& family) {
    return fmt::format("{}{}", name(family.kind),
                       has_hinges(family.kind) ? fmt::format(" on {}s", name(family.hinge)) : "");
}
std::string file_name(const Family& family) {
    return fmt::format("growth-{}{}", name(family.kind),
                       family.hinge == Hinge::revolute ? "-revolute" : "");
}

// ---- One command.

struct Cost {
    double seconds = 0, megabytes = 0;
    std::string outcome;  // empty: exit code 0
};

Cost once(const std::vector<std::string>& words, double max_seconds) {
    std::vector<std::string> copies = words;
    std::vector<char*> argv;
    for (auto& word : copies) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        const auto limit = static_cast<rlim_t>(std::ceil(max_seconds));
        const rlimit cpu{limit, limit + 1};
        const int nothing = ::open("/dev/null", O_RDWR);
        const bool ready = ::setrlimit(RLIMIT_CPU, &cpu) == 0 && nothing >= 0 &&
                           ::dup2(nothing, STDIN_FILENO) >= 0 &&
                           ::dup2(nothing, STDOUT_FILENO) >= 0 &&
                           ::dup2(nothing, STDERR_FILENO) >= 0;
        if (ready) ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    int status = 0;
    rusage used{};
    if (child < 0 || ::wait4(child, &status, 0, &used) != child)
        throw std::runtime_error("no process");
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    Cost cost{seconds(used.ru_utime) + seconds(used.ru_stime),
              static_cast<double>(used.ru_maxrss) / 1024, ""};
    if (WIFSIGNALED(status))
        cost.outcome = fmt::format("stopped after {:.0f} s", cost.seconds);
    else if (WEXITSTATUS(status) != 0)
        cost.outcome = fmt::format("exit code {}", WEXITSTATUS(status));
    return cost;
}

// The least of up to five runs, fewer where they are long.
Cost least(const std::vector<std::string>& words, double budget) {
    Cost best = once(words, 2 * budget);
    double sum = best.seconds;
    for (int run = 1; run < 5 && sum < 1 && best.outcome.empty(); ++run) {
        const Cost next = once(words, 2 * budget);
        sum += next.seconds;
        best.seconds = std::min(best.seconds, next.seconds);
        best.megabytes = std::min(best.megabytes, next.megabytes);
    }
    return best;
}

std::vector<std::string> command(const std::string& method, const std::string& scene) {
    if (method == "inspect") return {ELASTOCHECK_COMMAND, "inspect", scene};
    return {ELASTOCHECK_COMMAND, "solve", "--method", method, scene};
}

// ---- A family by a method, over its sizes.

struct Row {
    int bodies = 0;
    Cost cost;
};
struct Growth {
    Family family;
    std::string method;
    Cost start;  // of one body
    std::vector<Row> rows;

    std::vector<Row> done() const {
        std::vector<Row> kept;
        for (const Row& row : rows)
            if (row.cost.outcome.empty()) kept.push_back(row);
        return kept;
    }
};

// Of log(cost - start) over log(bodies), by least squares over the three largest sizes; NaN with less than two.
double exponent(const Growth& growth, double Cost::*what) {
    std::vector<std::pair<double, double>> points;
    for (const Row& row : growth.done())
        if (const double more = row.cost.*what - growth.start.*what; more > 0)
            points.emplace_back(std::log(row.bodies), std::log(more));
    if (points.size() > 3) points.erase(points.begin(), points.end() - 3);
    const auto n = static_cast<double>(points.size());
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& [u, v] : points) x += u / n, y += v / n;
    for (const auto& [u, v] : points) xx += (u - x) * (u - x), xy += (u - x) * (v - y);
    return points.size() < 2 ? std::numeric_limits<double>::quiet_NaN() : xy / xx;
}

double foretold(const Growth& growth, int bodies) {
    const auto done = growth.done();
    if (done.empty()) return 0;
    const auto more = [&](const Row& row) {
        return std::max(1e-3, row.cost.seconds - growth.start.seconds);
    };
    const Row& last = done.back();
    double p = 3;
    if (done.size() > 1) {
        const Row& before = done[done.size() - 2];
        p = std::max(1.0, std::log(more(last) / more(before)) /
                              std::log(static_cast<double>(last.bodies) / before.bodies));
    }
    return growth.start.seconds +
           more(last) * std::pow(static_cast<double>(bodies) / last.bodies, p);
}

Growth grow(const Family& family, const std::string& method, const std::vector<int>& sizes,
            const Cost& start, const std::filesystem::path& scratch, double budget) {
    Growth growth{family, method, start, {}};
    for (const int bodies : sizes) {
        const double seconds = foretold(growth, bodies);
        const std::string before = growth.rows.empty() ? "" : growth.rows.back().cost.outcome;
        if (before.starts_with("skipped") || before.starts_with("stopped")) {
            growth.rows.push_back({bodies, {0, 0, "skipped"}});
        } else if (seconds > budget) {
            growth.rows.push_back(
                {bodies, {0, 0, fmt::format("skipped: {:.0f} s foretold", seconds)}});
        } else {
            Family of_size = family;
            of_size.bodies = bodies;
            const auto file = scratch / "scene.yaml";
            std::ofstream(file) << scene(of_size);
            growth.rows.push_back({bodies, least(command(method, file), budget)});
        }
        const Cost& cost = growth.rows.back().cost;
        fmt::print(stderr, "{:22} {:12} {:5}  {}\n", title(family), method, bodies,
                   cost.seconds > 0 ? fmt::format("{:8.3f} s {:7.1f} MB {}", cost.seconds,
                                                  cost.megabytes, cost.outcome)
                                    : cost.outcome);
    }
    return growth;
}

// ---- What comes out.

std::string csv(const std::vector<Growth>& all) {
    std::string text = "family,joints,method,bodies,seconds,megabytes,outcome\n";
    const auto add = [&](const Growth& g, int bodies, const Cost& cost) {
        const bool ran = cost.seconds > 0;
        text += fmt::format("{},{},{},{},{},{},{}\n", name(g.family.kind),
                            has_hinges(g.family.kind) ? name(g.family.hinge) : "", g.method, bodies,
                            ran ? fmt::format("{:.3f}", cost.seconds) : "",
                            ran ? fmt::format("{:.1f}", cost.megabytes) : "",
                            cost.outcome.empty() ? "fine" : cost.outcome);
    };
    for (const Growth& g : all) {
        add(g, 1, g.start);
        for (const Row& row : g.rows) add(g, row.bodies, row.cost);
    }
    return text;
}

// One row a family, one column a method: what the largest size took that was solved, and the exponents.
std::string cell(const Growth& g) {
    const auto done = g.done();
    if (done.empty()) return g.rows.empty() ? "-" : g.rows.front().cost.outcome;
    const auto grows = [&](double Cost::*what) {
        const double p = exponent(g, what);
        return std::isfinite(p) ? fmt::format(" ~ n^{:.2f}", p) : "";
    };
    return fmt::format("{}: {:.2g} s{}, {:.0f} MB{}", done.back().bodies, done.back().cost.seconds,
                       grows(&Cost::seconds), done.back().cost.megabytes - g.start.megabytes,
                       grows(&Cost::megabytes));
}
void print_table(const std::vector<Growth>& all, const std::vector<std::string>& asked) {
    fmt::print("| family | {} |\n|---|", fmt::join(asked, " | "));
    for (std::size_t k = 0; k < asked.size(); ++k) fmt::print("---|");
    for (const Family& family : all_families) {
        bool first = true;
        for (const Growth& g : all) {
            if (title(g.family) != title(family)) continue;
            if (std::exchange(first, false)) fmt::print("\n| {} |", title(family));
            fmt::print(" {} |", cell(g));
        }
    }
    fmt::print("\n");
}

reports::Figure figure(const std::vector<Growth>& all, const Family& family) {
    reports::Figure picture{.id = file_name(family),
                            .title = fmt::format("CPU time of a {} over its bodies", title(family)),
                            .x = "bodies",
                            .y = fmt::format("{}: CPU time [s]", title(family)),
                            .log_x = true,
                            .log_y = true};
    const std::vector<reports::Colour> colours{reports::vermilion, reports::blue, reports::green,
                                               reports::purple, reports::slate};
    for (const Growth& g : all) {
        if (title(g.family) != title(family)) continue;
        const auto k =
            static_cast<std::size_t>(std::ranges::find(methods, g.method) - methods.begin());
        const double p = exponent(g, &Cost::seconds);
        reports::Series line{
            .title = g.method + (std::isfinite(p) ? fmt::format(", n^{:.2f}", p) : ""),
            .style = reports::Series::Style::line_points,
            .colour = colours[k],
            .mark = static_cast<int>(k)};
        for (const Row& row : g.done())
            line.rows.push_back({static_cast<double>(row.bodies), row.cost.seconds});
        if (!line.rows.empty()) picture.series.push_back(line);
    }
    picture.description =
        fmt::format("Logarithmic plot of the CPU time of the whole command over the bodies of a {}",
                    title(family));
    for (std::size_t k = 0; k < picture.series.size(); ++k)
        picture.description += fmt::format("{} {}", k == 0 ? ":" : ";", picture.series[k].title);
    return picture;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"How the cost of a scene grows with its bodies", "growth"};
    std::filesystem::path folder = ".";
    std::vector<int> sizes{30, 100, 300, 1000, 2000};
    std::vector<std::string> asked = methods, kinds;
    for (const Family& family : all_families)
        if (family.hinge == Hinge::bushing) kinds.emplace_back(name(family.kind));
    double budget = 20;
    app.add_option("-o,--output", folder, "folder for growth.csv and figures (default: this one)");
    app.add_option("--bodies", sizes, "sizes, rising (default: 30,100,300,1000,2000)")
        ->delimiter(',')
        ->check(CLI::Range(4, families::max_bodies));
    app.add_option("--families", kinds, "which (default: all)")
        ->delimiter(',')
        ->check(CLI::IsMember(kinds));
    app.add_option("--methods", asked, "which (default: all)")
        ->delimiter(',')
        ->check(CLI::IsMember(methods));
    app.add_option("--budget", budget, "CPU seconds that a run may take (default: 20)")
        ->check(CLI::Range(1., 1e5));
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        return 2;
    }
    namespace fs = std::filesystem;
    fs::create_directories(folder / "figures");
    std::string name = (fs::temp_directory_path() / "growth-XXXXXX").string();
    const fs::path scratch = ::mkdtemp(name.data());
    std::ofstream(scratch / "one.yaml") << scene(Family{Kind::chain, 1});
    std::vector<Growth> all;
    std::vector<reports::Figure> figures;
    for (const std::string& method : asked) {
        const Cost start = least(command(method, scratch / "one.yaml"), budget);
        for (const Family& family : all_families)
            if (std::ranges::find(kinds, families::name(family.kind)) != kinds.end())
                all.push_back(grow(family, method, sizes, start, scratch, budget));
    }
    fs::remove_all(scratch);
    std::ofstream(folder / "growth.csv") << csv(all);
    print_table(all, asked);
    for (const Family& family : all_families)
        if (auto picture = figure(all, family); !picture.series.empty())
            figures.push_back(std::move(picture));
    std::vector<reports::Plot> plots;
    for (const auto& picture : figures) plots.push_back({&picture, picture.id});
    reports::draw(plots, folder);
    const bool ran =
        std::ranges::all_of(all, [](const Growth& g) { return g.start.outcome.empty(); });
    return ran ? 0 : 3;
}
