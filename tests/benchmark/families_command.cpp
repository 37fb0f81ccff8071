// families KIND --bodies N [--joints bushing|revolute] > scene.yaml: a scene of any size, see families.hpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "tests/benchmark/families.hpp"

int main(int argc, char** argv) {
    using namespace elastocheck::families;
    CLI::App app{"Writes a scene of any size whose answer is known from elsewhere", "families"};
    Family family;
    std::vector<std::string> known;
    for (const Kind kind : kinds) known.emplace_back(name(kind));
    std::string kind, hinge = "bushing";
    app.add_option("KIND", kind, fmt::format("{}", fmt::join(known, ", ")))
        ->required()
        ->check(CLI::IsMember(known).description(""));
    app.add_option("--bodies", family.bodies, "how many")->required();
    app.add_option("--joints", hinge, "bushing (default) or revolute: what links hang on")
        ->check(CLI::IsMember({"bushing", "revolute"}).description(""));
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        return 2;
    }
    family.kind = kinds[static_cast<std::size_t>(std::ranges::find(known, kind) - known.begin())];
    family.hinge = hinge == "revolute" ? Hinge::revolute : Hinge::bushing;
    try {
        fmt::print("{}", scene(family));
    } catch (const std::logic_error& error) {
        fmt::print(stderr, "families: {}\n", error.what());
        return 2;
    }
    return 0;
}
