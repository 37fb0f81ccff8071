#include "models/reader/definitions/terms.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "models/kinds.hpp"
#include "models/reader/definitions/look_up.hpp"

namespace elastocheck::reader {

std::vector<Term> terms(const Cursor& field, const std::string& quantity) {
    std::vector<Term> terms;
    if (field.value->kind == Value::Kind::map) {
        for (std::size_t k = 0; k < field.value->keys.size(); ++k) {
            const std::string& name = field.value->keys[k];
            terms.push_back({name, field.at(field.value->items[k], field.path_of(name)), true});
        }
    } else {
        for (const Cursor& item : field.is_list() ? field.items() : std::vector<Cursor>{field}) {
            const std::string& name = item.text("the name of " + quantity);
            if (std::ranges::any_of(terms, [&](const Term& term) { return term.name == name; }))
                item.fail(fmt::format("{} is listed twice", quote(name)));
            terms.push_back({name, item});
        }
    }
    if (terms.empty()) field.fail(fmt::format("empty; {} is needed", quantity));
    return terms;
}

const Load& look_up_load(const Term& term, const Loads& loads) {
    if (const auto found = loads.find(term.name); found != loads.end()) return found->second;
    if (loads.empty())
        term.at.fail(
            fmt::format("there is no load called {}; the scene has no loads", quote(term.name)));
    term.at.fail(fmt::format("there is no load called {}{}", quote(term.name),
                             did_you_mean(term.name, names_of(loads), "defined")));
}

double held_value(const Term& term, const Load& load, const Units& units) {
    const Unit& unit = is_moment(load.kind) ? units.moment : units.force;
    return unit.si(term.number(unit.name));
}

}  // namespace elastocheck::reader
