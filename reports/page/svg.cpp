#include "reports/page/svg.hpp"

#include <fmt/format.h>

#include <iterator>

#include "reports/files/templates.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {

std::string px(double value) {
    std::string text = fmt::format("{:.1f}", value);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

std::string Svg::polyline(const std::vector<PaperPoint>& points, bool closed) {
    std::string path, before;
    int count = 0;
    for (const auto& p : points) {
        const std::string at = px(p.x) + "," + px(p.y);
        if (at == before) continue;
        path += (count++ == 0 ? "M" : "L") + at;
        before = at;
    }
    return count < 2 ? "" : path + (closed ? "Z" : "");
}

void Svg::stroke(const std::string& path, Colour colour, double line_width,
                 std::string_view attributes) {
    if (path.empty()) return;
    fmt::format_to(std::back_inserter(elements),
                   "<path class=\"e-s{}\" stroke-width=\"{}\"{} d=\"{}\"/>",
                   static_cast<int>(colour), px(line_width), attributes, path);
}

void Svg::area(const std::string& path, Colour colour, double opacity) {
    if (path.empty()) return;
    fmt::format_to(std::back_inserter(elements), "<path class=\"e-f{}\"{} d=\"{}\"/>",
                   static_cast<int>(colour),
                   opacity < 1 ? fmt::format(" fill-opacity=\"{:.2f}\"", opacity) : "", path);
}

void Svg::text(PaperPoint at, std::string_view text, Colour colour, std::string_view anchor,
               std::string_view attributes, std::string_view exponent) {
    fmt::format_to(
        std::back_inserter(elements),
        "<text class=\"e-f{}\" x=\"{}\" y=\"{}\" text-anchor=\"{}\"{}>{}{}</text>",
        static_cast<int>(colour), px(at.x), px(at.y), anchor, attributes, for_xml(text),
        exponent.empty()
            ? ""
            : fmt::format("<tspan font-size=\".8em\" dy=\"-.6em\">{}</tspan>", for_xml(exponent)));
}

Illustration illustrate(const Svg& svg, const std::string& id, const std::string& title,
                        const std::string& description) {
    const std::string head = fmt::format(
        "<svg width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "xmlns=\"http://www.w3.org/2000/svg\" fill=\"none\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\" font-size=\"{6}\" role=\"img\" "
        "aria-labelledby=\"{2}-title {2}-desc\"{5}><title id=\"{2}-title\">{3}</title>"
        "<desc id=\"{2}-desc\">{4}</desc>",
        svg.width, svg.height, id, for_xml(title), for_xml(description), svg.of_image,
        px(svg.letter));
    const std::string paper = "<style>" +
                              render("figure.css", {{"tints", tints()}}, Escape::nothing) +
                              "</style><rect class=\"e-paper\" width=\"100%\" height=\"100%\"/>";
    return {head + paper + svg.elements + "</svg>\n", head + svg.elements + "</svg>"};
}

nlohmann::ordered_json tints() {
    auto all = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < palette.size(); ++k)
        all.push_back({{"k", k}, {"light", palette[k].light}, {"dark", palette[k].dark}});
    return all;
}

}  // namespace elastocheck::reports
