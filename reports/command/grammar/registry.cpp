#include "reports/command/grammar/registry.hpp"

namespace elastocheck::reports {

// Each is in NAME_command.cpp; inspect, compare, converge and trade are in study_commands.cpp.
Command certify_command();
Command compare_command();
Command converge_command();
Command equilibria_command();
Command export_command();
Command gate_command();
Command import_command();
Command inspect_command();
Command judge_command();
Command new_command();
Command report_command();
Command solve_command();
Command stress_command();
Command trade_command();

std::vector<Command> registry() {
    return {inspect_command(), solve_command(),     compare_command(), converge_command(),
            trade_command(),   new_command(),       import_command(),  export_command(),
            gate_command(),    certify_command(),   judge_command(),   report_command(),
            stress_command(),  equilibria_command()};
}

}  // namespace elastocheck::reports
