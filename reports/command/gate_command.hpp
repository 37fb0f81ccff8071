// `elastocheck gate`: judge scenes by their baselines, or accept what they measure as the new ones.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string_view>

namespace elastocheck::reports {

// Adds the subcommand; what is returned runs it once parsed, and is empty of effect before.
struct GateCommand {
    CLI::App* parsed = nullptr;
    std::function<int()> run;
};
GateCommand add_gate(CLI::App& app, std::function<void(std::string_view)> progress);

}  // namespace elastocheck::reports
