#include "reports/page/svg.hpp"

#include <fmt/format.h>
#include <charconv>

#include <cctype>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "reports/files/templates.hpp"
#include "reports/page/gnuplot.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using pugi::xml_node;

// Palette index of "rgb(196,  66,  15)" or "#C4420F".
std::optional<std::size_t> colour_of(const char* text) {
    unsigned r = 0, g = 0, b = 0;
    if (std::sscanf(text, "rgb(%u,%u,%u)", &r, &g, &b) != 3 &&
        std::sscanf(text, "rgb( %u, %u, %u)", &r, &g, &b) != 3 &&
        std::sscanf(text, "#%2x%2x%2x", &r, &g, &b) != 3)
        return std::nullopt;
    const std::string name = fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
    for (std::size_t k = 0; k < palette.size(); ++k)
        if (palette[k].light == name) return k;
    return std::nullopt;
}

void classes_for_colours(xml_node node) {
    std::string classes;
    for (const auto& [attribute, letter] :
         {std::pair{"stroke", 's'}, std::pair{"fill", 'f'}, std::pair{"color", 'k'}}) {
        const auto colour = colour_of(node.attribute(attribute).value());
        if (!colour) continue;
        classes += fmt::format("{}e-{}{}", classes.empty() ? "" : " ", letter, *colour);
        node.remove_attribute(attribute);
    }
    node.remove_attribute("class");
    if (!classes.empty()) node.append_attribute("class") = classes.c_str();
    if (std::strcmp(node.attribute("color").value(), "black") == 0) node.remove_attribute("color");
    node.remove_attribute("font-family");
}

template <class F>
void for_each(xml_node node, F&& f) {
    for (xml_node child = node.first_child(); child;) {
        const xml_node next = child.next_sibling();
        for_each(child, f);
        f(child);
        child = next;
    }
}

bool is(const xml_node& node, const char* name) { return std::strcmp(node.name(), name) == 0; }

// Keeps the drawn symbols and those they refer to.
void keep_used_symbols(xml_node svg) {
    for (bool again = true; again;) {
        std::set<std::string> used;
        for_each(svg, [&](xml_node node) { used.insert(node.attribute("xlink:href").value()); });
        again = false;
        xml_node definitions = svg.find_node([](const xml_node& node) { return is(node, "defs"); });
        for (xml_node symbol = definitions.first_child(); symbol;) {
            const xml_node next = symbol.next_sibling();
            if (!used.contains(fmt::format("#{}", symbol.attribute("id").value())))
                again = definitions.remove_child(symbol) || again;
            symbol = next;
        }
        if (definitions && !definitions.first_child())
            definitions.parent().remove_child(definitions);
    }
}

// Rounds numbers to a tenth of a pixel, and collapses spaces.
std::string coarser(std::string_view text) {
    std::string result;
    for (std::size_t k = 0; k < text.size();) {
        const std::size_t end = std::min(text.find_first_not_of("0123456789.", k), text.size());
        const std::string_view word = text.substr(k, end - k);
        if (word.find('.') != word.npos) {
            double value = 0;  // decimal point in any locale, as written by gnuplot
            std::from_chars(word.data(), word.data() + word.size(), value);
            std::string number = fmt::format("{:.1f}", value);
            if (number.ends_with(".0")) number.resize(number.size() - 2);
            result += number;
        } else if (!word.empty()) {
            result += word;
        } else if (const bool space = std::isspace(static_cast<unsigned char>(text[k])) != 0;
                   !space || (!result.empty() && result.back() != ' ')) {
            result.push_back(space ? ' ' : text[k]);
        }
        k = word.empty() ? k + 1 : end;
    }
    while (result.ends_with(' ')) result.pop_back();
    return result;
}

bool same_attributes(const xml_node& a, const xml_node& b) {
    auto x = a.first_attribute(), y = b.first_attribute();
    for (; x && y; x = x.next_attribute(), y = y.next_attribute())
        if (std::strcmp(x.name(), y.name()) != 0 || std::strcmp(x.value(), y.value()) != 0)
            return false;
    return !x && !y;
}

// Attributes repeated by nearly every group; they move to the root.
constexpr std::pair<const char*, const char*> usual[] = {{"fill", "none"},
                                                         {"stroke", "currentColor"},
                                                         {"stroke-linecap", "round"},
                                                         {"stroke-linejoin", "round"},
                                                         {"font-size", "11.00"}};

// Merges neighbouring groups of equal attributes: gnuplot opens a group for nearly every stroke,
// and a page has many figures.
void shrink(xml_node root) {
    std::set<std::string> used;
    for_each(root, [&](xml_node node) { used.insert(node.attribute("xlink:href").value()); });
    for_each(root, [&](xml_node node) {
        if (!used.contains(fmt::format("#{}", node.attribute("id").value())))
            node.remove_attribute("id");
        for (const auto& [name, value] : usual)
            if (is(node, "g") && std::strcmp(node.attribute(name).value(), value) == 0)
                node.remove_attribute(name);
        for (const char* name : {"d", "points", "transform"})
            if (auto attribute = node.attribute(name))
                attribute = coarser(attribute.value()).c_str();
    });
    for (const auto& [name, value] : usual) root.append_attribute(name) = value;
    for_each(root, [](xml_node node) {
        xml_node before = node.previous_sibling();
        if (!is(node, "g") || !is(before, "g") || !same_attributes(node, before) ||
            node.attribute("transform"))
            return;
        // for_each proceeds to the next sibling, so the later one is kept
        while (const xml_node child = before.last_child()) node.prepend_move(child);
        before.parent().remove_child(before);
    });
}

std::string text(const xml_node& node) {
    std::ostringstream out;
    node.print(out, "", pugi::format_raw);
    return out.str();
}

}  // namespace

Illustration illustrate(const std::string& svg, const std::string& id, const std::string& title,
                        const std::string& description) {
    pugi::xml_document document;
    if (!document.load_string(svg.c_str()) || !document.child("svg"))
        throw PlotError(
            fmt::format("gnuplot wrote no whole SVG of figure {}; is the disk full?", id));
    xml_node root = document.child("svg");
    for_each(root, [](xml_node node) {
        if (is(node, "title") || is(node, "desc")) node.parent().remove_child(node);
    });
    keep_used_symbols(root);
    for_each(root, [](xml_node node) {
        // canvas for a background colour, which is not set
        if (is(node, "rect") && std::strcmp(node.attribute("fill").value(), "none") == 0)
            node.parent().remove_child(node);
    });
    for_each(root, [](xml_node node) {
        if (is(node, "g") && !node.first_child()) node.parent().remove_child(node);
    });
    classes_for_colours(root);
    for_each(root, [&](xml_node node) {
        classes_for_colours(node);
        if (auto name = node.attribute("id")) name = fmt::format("{}-{}", id, name.value()).c_str();
        if (auto reference = node.attribute("xlink:href"))
            reference = fmt::format("#{}-{}", id, reference.value() + 1).c_str();
    });
    shrink(root);
    const std::string title_id = id + "-title", description_id = id + "-desc";
    root.append_attribute("role") = "img";
    root.append_attribute("aria-labelledby") =
        fmt::format("{} {}", title_id, description_id).c_str();
    xml_node about = root.prepend_child("desc");
    about.append_attribute("id") = description_id.c_str();
    about.text() = for_xml(description).c_str();
    xml_node name = root.prepend_child("title");
    name.append_attribute("id") = title_id.c_str();
    name.text() = for_xml(title).c_str();

    Illustration result;
    result.inlined = text(root);
    xml_node paper = root.insert_child_after("rect", about);
    paper.append_attribute("class") = "e-paper";
    paper.append_attribute("width") = "100%";
    paper.append_attribute("height") = "100%";
    nlohmann::ordered_json tints = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < palette.size(); ++k)
        tints.push_back({{"k", k}, {"light", palette[k].light}, {"dark", palette[k].dark}});
    root.insert_child_after("style", about).text() =
        render("figure.css", {{"tints", tints}}, Escape::nothing).c_str();
    result.alone = text(root) + "\n";
    return result;
}

}  // namespace elastocheck::reports
