// `elastocheck stress`: every leg and method at the extremes, and the survival map.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/command/arguments.hpp"
#include "reports/command/delivery.hpp"

namespace elastocheck::reports {

struct StressRequest {
    std::vector<std::string> scenes;  // files; none: the built-in ones
    Settings settings;
};

CLI::App* add_stress_command(CLI::App& app, StressRequest& request);

// 0: nothing is wrong; 1: something is; 3: nothing could be judged.
int stress(const StressRequest& request, const Delivery& delivery,
           const std::function<void(std::string_view)>& progress);

}  // namespace elastocheck::reports
