// Report folder, made from one result document alone.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/files/folder.hpp"

namespace elastocheck::reports {

struct ReportOptions {
    std::function<void(std::string_view)> progress = {};
    std::string live = {};  // text of live.html, which the page links to; empty: none
};

// Answer of the report for a scene in one sentence, with its source.
struct Answer {
    std::string name, source;
    std::string
        sentence;  // how far the numbers can be trusted, and which fast method is good enough
    // "pass", "fail", "not judged" of the candidates where there are any; else "judged" or "not
    // judged"
    std::string mark;
    bool conclusive = false;           // it could be judged
    std::vector<std::string> reasons;  // reasons if not
};

// Replaces `folder` by report.html, report.md, result.json, curves.csv and figures/, in one step,
// and returns the answer of each scene. NaN is null in `result`; `file` is its name in messages. Throws ResultError, FileError; an older report is then untouched.
std::vector<Answer> write_report(const nlohmann::ordered_json& result, const std::string& file,
                                 const std::filesystem::path& folder,
                                 const ReportOptions& options = {});

// scene,branch,output,unit,quantity,value,tolerance: numbers for regression tests between runs,
// with the tolerance of each for other compilers.
std::string numbers_csv(const nlohmann::ordered_json& result, const std::string& file);

}  // namespace elastocheck::reports
