// study.html: statistics of a study, and for each figure its histogram, the shares of its variance
// and its values over the three variables that matter most.
#pragma once

#include <filesystem>
#include <string>

#include "reports/study/ledger.hpp"
#include "reports/study/output/study_output.hpp"
#include "reports/study/study_file.hpp"

namespace elastocheck::reports {

// `command`: as given. Throws FileError.
void write_study_page(const StudyFile& file, const StudyResult& result, const Ledger& ledger,
                      const std::string& command, const std::filesystem::path& output);

}  // namespace elastocheck::reports
