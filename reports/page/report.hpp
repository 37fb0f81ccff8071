// A report: a folder made of one result document, and of nothing else.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace elastocheck::reports {

// Parses a result document of the present schema. Throws ResultError, naming `file`.
nlohmann::ordered_json parse_result(std::string_view text, const std::string& file);

struct ReportOptions {
    bool pdf = false;      // figures as PDF too
    bool archive = false;  // only what belongs in version control: README.md, numbers.csv, figures/*.svg
    std::function<void(std::string_view)> progress = {};
};

// Replaces `folder` by report.html, report.md, result.json, curves.csv and figures/, in one step. `result` is
// what parse_result gave, `file` its name for messages. Throws ResultError, PlotError, FileError; an older
// report is then untouched.
// Returns the answer of each scene: the first paragraph of its verdict.
std::vector<std::string> write_report(const nlohmann::ordered_json& result, const std::string& file,
                                      const std::filesystem::path& folder, const ReportOptions& options = {});

// scene,branch,output,unit,quantity,value,tolerance: the numbers by which a later run is told from this one,
// and how far each may move with the compiler.
std::string numbers_csv(const nlohmann::ordered_json& result, const std::string& file);

}  // namespace elastocheck::reports
