// `elastocheck report`: everything the other commands find, as a page.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/command/arguments.hpp"
#include "reports/command/candidate_options.hpp"

namespace elastocheck::reports {

struct ReportRequest {
    std::vector<std::string> scenes;
    Settings settings;
    std::string from;  // a result.json, in place of scenes
    std::string folder;
    std::string measured;                  // CSV
    std::string branch_column = "branch";  // of it
    std::vector<std::string> cases;  // "THEIRS=OURS": names in that column, and the branches that they mean
    CandidateRequest candidate;      // somebody else's solver, of one scene
    std::string alarms;              // JSON, what `./dev mutate` found
    std::string stress;              // JSON, what `elastocheck stress` found
    std::string tolerance = "0.01mm,0.001deg";
    std::string figures = "svg";
    bool archive = false;
    bool as_json = false;  // the answers as a document on standard output
    bool open = false;     // the page in a browser, once it is there
};

inline constexpr const char* report_schema = "elastocheck/report/1";

CLI::App* add_report_command(CLI::App& app, ReportRequest& request);

// The exit code. `reproduce` is the command line as given; `progress` is told what is being done.
int report(const ReportRequest& request, const std::string& reproduce,
           const std::function<void(std::string_view)>& progress);

}  // namespace elastocheck::reports
