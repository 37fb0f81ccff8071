// What a study reports: text, JSON, CSV.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "compare/result/table.hpp"
#include "compare/variants/statistics.hpp"
#include "reports/study/ledger.hpp"
#include "reports/study/study_file.hpp"

namespace elastocheck::reports {

inline constexpr const char* study_schema = "elastocheck/study/1";

struct StudyResult {
    LedgerSummary summary;
    std::vector<compare::variants::FigureStatistics> figures;
    compare::variants::VariantFigures design;  // the scene as it is written
    std::vector<WitnessDifference> witnesses;
    std::vector<LedgerRow> failed;  // the first ones
    std::string content_hash;
    std::vector<std::string> disagreements;  // of witnesses; each a sentence
};
// From the rows that are in the ledger.
StudyResult evaluate_study(const StudyFile& file, const Ledger& ledger);

// With their captions; some have no row.
std::vector<std::pair<std::string, compare::Table>> study_tables(const StudyFile& file,
                                                                 const StudyResult& result);
std::string outcomes_text(const StudyResult& result);  // "98 solved, 2 no scene"

std::string study_text(const StudyFile& file, const StudyResult& result);
nlohmann::ordered_json study_json(const StudyFile& file, const StudyResult& result);

// "points.tie_rod_inner.z [m]", "toe at full jounce [deg]": names of columns.
std::string heading(const compare::variants::Variable& variable);
std::string heading(const compare::variants::StudyFigure& figure);

// A line for every row of the ledger: variant, outcome, reason, values of the variables, figures.
// Throws FileError.
void write_study_csv(const StudyFile& file, const Ledger& ledger,
                     const std::filesystem::path& output);

}  // namespace elastocheck::reports
