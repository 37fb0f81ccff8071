// Figures by gnuplot, with script and data kept beside each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/files/folder.hpp"
#include "reports/page/page.hpp"
#include "reports/page/svg.hpp"

namespace elastocheck::reports {

struct Plot {
    const Figure* figure = nullptr;
    std::string name;  // of its files, without extension
};

struct PlotOptions {
    bool pdf = false;         // PDF files too
    bool keep_source = true;  // scripts and data
};

// Script and data of a figure: NAME.csv, NAME.gp.
std::vector<NamedContent> sources(const Plot& plot);

// Writes figures/NAME.svg with NAME.gp and NAME.csv into `folder`; one picture per plot. The k-th
// picture's ids begin with "fk", counted from 1. Throws PlotError, FileError.
std::vector<Illustration> draw(const std::vector<Plot>& plots, const std::filesystem::path& folder,
                               const PlotOptions& options);

}  // namespace elastocheck::reports
