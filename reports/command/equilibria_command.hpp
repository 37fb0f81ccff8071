// `elastocheck equilibria`: all that can be found at one load, each proved, and what they mean for the branch.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>

#include "reports/command/arguments.hpp"
#include "reports/command/delivery.hpp"

namespace elastocheck::reports {

struct EquilibriaRequest {
    std::string scene;
    Settings settings;
    std::string branch;  // empty: the first
    double at = 0;       // of its parameter, as reports show it: N, N·m, mm, deg
    double turned = 90;  // what is listed has no body turned further [deg]
};

CLI::App* add_equilibria_command(CLI::App& app, EquilibriaRequest& request);

// 0: the branch arrives there, and what was found is proved; 3: not so.
int equilibria(const EquilibriaRequest& request, const Delivery& delivery,
               const std::function<void(std::string_view)>& progress);

}  // namespace elastocheck::reports
