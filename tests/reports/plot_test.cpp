// Plots: round ticks, logarithmic axes, clipping, gaps.
#include "reports/page/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>

#include "reports/text/labels.hpp"

namespace elastocheck::reports {
namespace {

Figure line(std::vector<std::vector<double>> rows) {
    Figure figure{.id = "f", .title = "t", .description = "d", .x = "x", .y = "y"};
    figure.series.push_back({"s", Series::Style::line, vermilion, 0, std::move(rows)});
    return figure;
}

// Texts of an image, with superscripts after ^.
std::vector<std::string> texts(const Svg& svg) {
    std::vector<std::string> found;
    const std::regex text("<text[^>]*>([^<]*)(?:<tspan[^>]*>([^<]*)</tspan>)?</text>");
    for (std::sregex_iterator at(svg.elements.begin(), svg.elements.end(), text), end; at != end;
         ++at)
        found.push_back((*at)[1].str() + ((*at)[2].matched ? "^" + (*at)[2].str() : ""));
    return found;
}

// Path data of the elements with this stroke colour.
std::vector<std::string> strokes(const Svg& svg, Colour colour) {
    std::vector<std::string> found;
    const std::regex path("class=\"e-s" + std::to_string(static_cast<int>(colour)) +
                          "\"[^>]* d=\"([^\"]*)\"");
    for (std::sregex_iterator at(svg.elements.begin(), svg.elements.end(), path), end; at != end;
         ++at)
        found.push_back((*at)[1]);
    return found;
}

TEST(Plot, TicksAreRoundAndEncloseTheData) {
    const auto words = texts(draw(line({{-75, 25.6}, {80, 187}})));
    EXPECT_EQ(words,
              (std::vector<std::string>{"20",  "40",  "60",  "80",  "100", "120", "140", "160",
                                        "180", "200", "−80", "−60", "−40", "−20", "0",   "20",
                                        "40",  "60",  "80",  "y",   "x",   "s"}));
}

TEST(Plot, LastLabelOfTheAbscissaIsWithinTheImage) {
    for (const double end : {1e-5, 0.00015, 40., 1234567.}) {
        const Svg svg = draw(line({{-end, 0}, {end, 1}}));
        const std::regex text("<text[^>]* x=\"([-0-9.]+)\"[^>]*\"middle\"[^>]*>([^<]*)</text>");
        int labels = 0;
        for (std::sregex_iterator at(svg.elements.begin(), svg.elements.end(), text), none;
             at != none; ++at, ++labels)
            EXPECT_LE(std::stod((*at)[1]) + text_width((*at)[2].str(), svg.letter) / 2, svg.width)
                << (*at)[2];
        EXPECT_GE(labels, 3);
    }
}

TEST(Plot, LogarithmicTicksArePowersOfTen) {
    Figure figure = line({{20, 1e-9}, {3000, 0}, {8e4, 3}});
    figure.log_x = figure.log_y = true;
    const auto words = texts(draw(figure));
    EXPECT_EQ(words, (std::vector<std::string>{"10^−10", "10^−8", "10^−6", "10^−4", "10^−2", "10^0",
                                               "10^2", "10^1", "10^2", "10^3", "10^4", "10^5", "y",
                                               "x", "s"}));
    // Zero has no place on a logarithmic axis: two single points are no line; the legend's is left.
    EXPECT_EQ(strokes(draw(figure), vermilion).size(), 1u);
}

TEST(Plot, ALineIsClippedAtFixedLimitsAndBrokenAtAGap) {
    Figure figure = line({{0, -1}, {1, 1}, {2, 3}, {}, {3, 1}, {4, 1}});
    figure.y_low = 0, figure.y_high = 2;
    const auto found = strokes(draw(figure), vermilion);
    ASSERT_EQ(found.size(), 2u);  // legend and curve
    EXPECT_EQ(std::ranges::count(found[1], 'M'), 2) << found[1];
    EXPECT_EQ(std::ranges::count(found[1], 'L'), 3) << found[1];
}

// A steep stop at the end of a wheel rate, and a pole of Ackermann's figure.
TEST(Plot, AxisFitsTheBulkOfALineAndSaysWhatItCuts) {
    std::vector<std::vector<double>> stop, pole, smooth;
    for (int k = -20; k <= 20; ++k) {
        stop.push_back({4.0 * k, 30 + 0.05 * k + (k > 16 ? 400.0 * (k - 16) : 0)});
        if (k != 0)
            pole.push_back({1.0 * k, 60 + 30.0 / k * std::abs(k) + (std::abs(k) < 2 ? 9e4 : 0)});
        smooth.push_back({1.0 * k, std::exp(0.1 * k)});
    }
    const auto highest = [](const Svg& svg) {
        double most = -INFINITY;
        for (const auto& word : texts(svg)) {
            double value = 0;
            const auto [end, error] =
                std::from_chars(word.data(), word.data() + word.size(), value);
            if (error == std::errc{} && end == word.data() + word.size())
                most = std::max(most, value);
        }
        return most;
    };
    const auto cut = [](const Svg& svg) {
        const auto words = texts(svg);
        const auto found = std::ranges::find_if(
            words, [](const std::string& word) { return word.starts_with("axis cut"); });
        return found == words.end() ? std::string() : *found;
    };
    EXPECT_LE(highest(draw(line(stop))), 100);
    EXPECT_EQ(cut(draw(line(stop))), "axis cut: values from 29.0 to 1631");
    EXPECT_LE(highest(draw(line(pole))), 500);
    EXPECT_NE(cut(draw(line(pole))), "");
    EXPECT_GE(highest(draw(line(smooth))), 7) << "a curve that grows is shown whole";
    EXPECT_EQ(cut(draw(line(smooth))), "");
    // a line that is elsewhere keeps its own place
    Figure both = line(stop);
    both.series.push_back({"t", Series::Style::line, blue, 0, {{0, 900}, {40, 905}}});
    EXPECT_GE(highest(draw(both)), 900);
}

TEST(Plot, DegenerateDataHaveAxes) {
    for (const auto& rows : {std::vector<std::vector<double>>{},
                             {{1, 1}},
                             {{0, 0}, {1, 0}},
                             {{0, NAN}, {1, INFINITY}},
                             {{5, 1e300}, {5, 1e300}}})
        for (const bool logarithmic : {false, true}) {
            Figure figure = line(rows);
            figure.log_x = figure.log_y = logarithmic;
            const std::string text = draw(figure).elements;
            EXPECT_EQ(text.find("nan"), text.npos) << text;
            EXPECT_EQ(text.find("inf"), text.npos) << text;
            EXPECT_GE(texts(draw(figure)).size(), 6u);
        }
}

}  // namespace
}  // namespace elastocheck::reports
