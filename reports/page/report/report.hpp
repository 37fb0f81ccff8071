// Report folder, made from the results of its scenes alone.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/document/scene_analyses.hpp"
#include "reports/files/folder.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {

struct Report {
    std::string reproduce;  // the command that made it
    Provenance provenance;
    std::vector<SceneAnalyses> scenes;
};

// result.json: without what differs from run to run. A number that is not finite is null.
nlohmann::ordered_json report_json(const Report& report);

struct ReportOptions {
    std::function<void(std::string_view)> progress = {};
    std::string live = {};  // text of live.html, which the page links to; empty: none
};

// Answer of the report for a scene in one sentence, with its source.
struct Answer {
    std::string name, source;
    // how far the numbers can be trusted, and which fast method is good enough
    std::string sentence;
    // "pass", "fail", "not judged" of the candidates where there are any; else "judged"
    // or "not judged"
    std::string mark;
    bool conclusive = false;           // it could be judged
    std::vector<std::string> reasons;  // why not
};

// Replaces `folder` by report.html, report.md, result.json, curves.csv and figures/, in one step,
// and returns the answer of each scene. Throws FileError; an older report is then untouched.
std::vector<Answer> write_report(const Report& report, const std::filesystem::path& folder,
                                 const ReportOptions& options = {});

// scene,branch,output,unit,quantity,value,tolerance: numbers for regression tests between runs,
// with the tolerance of each for other compilers.
std::string numbers_csv(const std::vector<SceneAnalyses>& scenes);

}  // namespace elastocheck::reports
