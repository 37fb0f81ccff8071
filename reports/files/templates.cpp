#include "reports/files/templates.hpp"

#include <fmt/format.h>

#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "reports/text/escape.hpp"
#include "templates_embedded.hpp"  // generated: name and text of every template

namespace elastocheck::reports {
namespace {

namespace ms = kainjow::mustache;
using json = nlohmann::ordered_json;

std::string_view text_of(std::string_view name) {
    for (const auto& entry : embedded_templates)
        if (entry.name == name) return entry.text;
    throw std::logic_error(fmt::format("no template '{}'", name));
}

ms::data mustache(const json& value) {
    switch (value.type()) {
        case json::value_t::object: {
            ms::data object{ms::data::type::object};
            for (const auto& [key, entry] : value.items()) object.set(key, mustache(entry));
            return object;
        }
        case json::value_t::array: {
            ms::data list{ms::data::type::list};
            for (const auto& entry : value) list.push_back(mustache(entry));
            return list;
        }
        case json::value_t::string: return ms::data{value.get<std::string>()};
        case json::value_t::boolean: return ms::data{value.get<bool>()};
        case json::value_t::null: return ms::data{false};
        default: return ms::data{value.dump()};
    }
}

}  // namespace

std::string render(std::string_view name, const json& data, Escape escape) {
    ms::mustache page{std::string(text_of(name))};
    if (!page.is_valid())
        throw std::logic_error(fmt::format("template '{}': {}", name, page.error_message()));
    page.set_custom_escape([escape](const std::string& text) {
        switch (escape) {
            case Escape::html: return for_html(text);
            case Escape::markdown: return for_markdown(text);
            case Escape::nothing: break;
        }
        return text;
    });
    ms::data root = mustache(data);
    for (const auto& entry : embedded_templates)
        root.set(std::string(entry.name),
                 ms::partial{[text = entry.text] { return std::string(text); }});
    return page.render(root);
}

}  // namespace elastocheck::reports
