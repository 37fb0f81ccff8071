// `elastocheck certify`: prove, point by point, what a solver found.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace elastocheck::reports {

// Adds the subcommand; what is returned runs it once parsed, told the command line.
struct CertifyCommand {
    CLI::App* parsed = nullptr;
    std::function<int(const std::string& command)> run;
};
CertifyCommand add_certify(CLI::App& app);

}  // namespace elastocheck::reports
