// A report: a folder made of one result document, and of nothing else.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/files/folder.hpp"

namespace elastocheck::reports {

// Parses a result document of the present schema. Throws ResultError, naming `file`.
nlohmann::ordered_json parse_result(std::string_view text, const std::string& file);

// Everything in a report that is text, scripts and data of its figures too; nothing is drawn, nothing is written: what a
// document made elsewhere comes to. Throws ResultError.
std::vector<NamedContent> report_texts(const nlohmann::ordered_json& result, const std::string& file);

struct ReportOptions {
    bool pdf = false;      // figures as PDF too
    bool archive = false;  // only what belongs in version control: README.md, numbers.csv, figures/*.svg
    std::function<void(std::string_view)> progress = {};
};

// What the report says of a scene in a sentence, and how that was found.
struct Answer {
    std::string name, source;
    std::string sentence;              // the first paragraph of its verdict
    std::string mark;                  // "pass", "fail", "not judged" where the document holds it against a
                                       // tolerance; else "judged" or "not judged"
    bool conclusive = false;           // it could be judged; else
    std::vector<std::string> reasons;  // why not
};

// Replaces `folder` by report.html, report.md, result.json, curves.csv and figures/, in one step. `result` is
// what parse_result gave, `file` its name for messages. Throws ResultError, PlotError, FileError; an older
// report is then untouched.
// Returns the answer of each scene.
std::vector<Answer> write_report(const nlohmann::ordered_json& result, const std::string& file,
                                 const std::filesystem::path& folder, const ReportOptions& options = {});

// scene,branch,output,unit,quantity,value,tolerance: the numbers by which a later run is told from this one,
// and how far each may move with the compiler.
std::string numbers_csv(const nlohmann::ordered_json& result, const std::string& file);

}  // namespace elastocheck::reports
