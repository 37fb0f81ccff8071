// Looks up a name that is defined elsewhere in the scene.
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reader {

template <class T>
std::vector<std::string> names_of(const std::map<std::string, T>& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.push_back(entry.first);
    return names;
}

// The table entry that `field` names; the error message suggests the nearest name. `kind` names the
// kind of entry, e.g. "hardpoint".
template <class T>
const T& look_up(const Cursor& field, const char* kind, const std::map<std::string, T>& table) {
    const std::string& name = field.text("the name of a ", kind);
    if (const auto found = table.find(name); found != table.end()) return found->second;
    field.fail(fmt::format("there is no {} called {}{}", kind, quote(name),
                           did_you_mean(name, names_of(table), "defined")));
}

}  // namespace elastocheck::reader
