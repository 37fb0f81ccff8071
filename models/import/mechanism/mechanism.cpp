// Makes a mechanism of named points: recognises the role of each point by the words of its name
// (mechanisms.yaml).
#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "mechanism_embedded.hpp"  // generated: text of mechanisms.yaml
#include "models/import/import.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer {
namespace {

using Eigen::Vector3d;
using reader::Value;
using Words = std::set<std::string>;

Words words_between_blanks(std::string_view text) {
    const auto words = split(text, " ");
    return {words.begin(), words.end()};
}

bool lists(const Value& list, std::string_view word) {
    return std::ranges::find(list.items, word, &Value::text) != list.items.end();
}

// Words of a name in small letters: "CHAS_LowFor" is chas, low, for; "PPAttPnt" is pp, att, pnt.
std::vector<std::string> split_name(std::string_view name) {
    std::vector<std::string> words(1);
    const auto is_capital = [&](std::size_t k) {
        return k < name.size() && name[k] >= 'A' && name[k] <= 'Z';
    };
    for (std::size_t k = 0; k < name.size(); ++k) {
        const bool is_part = reader::is_letter(name[k]);
        const bool begins = is_capital(k) && k > 0 &&
                            (!is_capital(k - 1) || (k + 1 < name.size() && !is_capital(k + 1) &&
                                                    reader::is_letter(name[k + 1])));
        if ((!is_part || begins) && !words.back().empty()) words.emplace_back();
        if (is_part) words.back() += reader::small_letters(name.substr(k, 1));
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

struct PlacedPoint {
    std::string name;  // in the file
    Vector3d at;
    SourceLocation from;
    Words words = {};  // of its name, as in the phrases of roles
    Words marks = {};  // of its side and axle
    bool has_role = false;
    bool is_mirrored = false;  // the mirror image of a point, of a file with one side
};

// The point with the words and marks of its name.
PlacedPoint parsed_point(std::string name, const Vector3d& at, const SourceLocation& from) {
    PlacedPoint point{std::move(name), at, from};
    std::vector<std::string> words = split_name(point.name);
    if (words.size() > 1 && words[1] == "axle" && (words[0] == "front" || words[0] == "rear")) {
        point.marks.insert(words[0] + " axle");
        words.erase(words.begin(), words.begin() + 2);
    }
    for (const std::string& word : words) {
        bool is_mark = false;
        const Value& marks = mechanism_table("marks");
        for (std::size_t k = 0; k < marks.keys.size(); ++k)
            if (lists(marks.items[k], word)) {
                point.marks.insert(marks.keys[k]);
                is_mark = true;
            }
        if (is_mark) continue;
        const Value& known = mechanism_table("words");
        const auto synonyms =
            std::ranges::find_if(known.items, [&](const Value& list) { return lists(list, word); });
        if (synonyms == known.items.end())
            point.words.insert(word);
        else
            point.words.merge(words_between_blanks(
                known.keys[static_cast<std::size_t>(synonyms - known.items.begin())]));
    }
    return point;
}

struct Role {
    std::string name;
    std::vector<Words> phrases = {};  // a point fits if its name has all words of one
    PlacedPoint* point = nullptr;
    std::string side = {};  // "left" or "right" of a mechanism with both wheels
};

// The sides for which an entry with SIDE in its name is written; an empty one for others.
std::vector<std::string> sides_of(const std::string& name) {
    return name.find("SIDE") == name.npos ? std::vector<std::string>{""}
                                          : std::vector<std::string>{"left", "right"};
}

// Number of words of the longest phrase of the role that the point's name has; 0 if it has none.
std::size_t fit(const Role& role, const PlacedPoint& point) {
    std::size_t most = 0;
    if (role.side.empty() ? point.is_mirrored : !point.marks.contains(role.side)) return 0;
    for (const Words& phrase : role.phrases) {
        const bool has_all = std::ranges::includes(point.words, phrase);
        const bool is_of_kind =
            std::ranges::all_of(mechanism_table("kinds").items, [&](const Value& kind) {
                return !point.words.contains(kind.text) || phrase.contains(kind.text);
            });
        if (has_all && is_of_kind) most = std::max(most, phrase.size());
    }
    return most;
}

struct MechanismMaker {
    const std::string& file;
    const Options& options;
    Draft& draft;
    const Value& pattern;  // the template, of mechanisms.yaml
    std::vector<PlacedPoint> points = {};
    std::vector<Role> roles = {};

    [[noreturn]] void fail(const std::string& option, const std::string& what) const {
        reader::fail(file, 0, option, what);
    }

    // Keeps the points of one axle, and of one side or, for a mechanism with both wheels, of both.
    void choose_points() {
        for (std::size_t k = 0; k < draft.points.entries().size(); ++k) {
            const Entry& entry = draft.points.entries()[k];
            if (entry.from.line == 0) continue;  // added by an importer
            points.push_back(
                parsed_point(entry.from.what, draft.points.positions()[k], entry.from));
        }
        const auto has = [&](const char* mark) {
            return std::ranges::any_of(
                points, [&](const PlacedPoint& p) { return p.marks.contains(mark); });
        };
        const auto drop = [&](const std::string& mark, const char* why) {
            std::erase_if(points, [&](const PlacedPoint& p) {
                if (p.marks.contains(mark)) draft.notes.leave_out(why, p.from);
                return p.marks.contains(mark);
            });
        };
        if (has("front axle") && has("rear axle")) {
            if (options.axle != "front" && options.axle != "rear")
                fail("--axle", "the names are of two axles; choose one: front, rear");
            drop(options.axle == "front" ? "rear axle" : "front axle", "of the other axle");
        } else if (!options.axle.empty()) {
            fail("--axle", "the names of the points are not of two axles");
        }
        if (entry(pattern, "wheels")) {
            if (!has("right")) mirror_points();
        } else if (has("left") && has("right")) {
            drop("right", "of the other side");
        }
    }

    // Adds the mirror images of points off the middle plane, for a file with one side.
    void mirror_points() {
        for (std::size_t k = 0, end = points.size(); k < end; ++k) {
            if (points[k].at.y() == 0) continue;
            points[k].marks.insert("left");
            PlacedPoint other = points[k];
            other.at.y() *= -1;
            other.marks = {"right"};
            other.is_mirrored = true;
            points.push_back(std::move(other));
        }
    }

    void add_roles(const Value& group) {
        const Value* list = entry(group, "roles");
        for (std::size_t k = 0; list && k < list->keys.size(); ++k)
            for (const std::string& side : sides_of(list->keys[k])) {
                Role role{replaced(list->keys[k], "SIDE", side)};
                role.side = side;
                for (const Value& phrase : list->items[k].items)
                    role.phrases.push_back(words_between_blanks(phrase.text));
                roles.push_back(std::move(role));
            }
    }

    bool is_role_of(const Value& group, const Role& role) const {
        return std::ranges::any_of(entry(group, "roles")->keys, [&](const std::string& name) {
            return role.side.empty() ? name == role.name
                                     : replaced(name, "SIDE", role.side) == role.name;
        });
    }

    // Assigns a point as --role ROLE=POINT says.
    void assign(const std::string& text) {
        const auto equals = std::min(text.find('='), text.size());
        const std::string name = text.substr(0, equals),
                          wanted = text.substr(std::min(equals + 1, text.size()));
        std::vector<std::string> names, known;
        for (const Role& role : roles) names.push_back(role.name);
        for (const PlacedPoint& point : points) known.push_back(point.name);
        const auto role = std::ranges::find(roles, name, &Role::name);
        if (role == roles.end())
            fail("--role", fmt::format("{} is not a role of this mechanism{}", reader::quote(name),
                                       reader::did_you_mean(name, names, "roles")));
        const auto point = std::ranges::find(points, wanted, &PlacedPoint::name);
        if (point == points.end())
            fail("--role", fmt::format("{}: there is no point {}{}", name, reader::quote(wanted),
                                       reader::did_you_mean(wanted, known, "points")));
        if (role->point || point->has_role)
            fail("--role", fmt::format("{}: the role or its point is given twice", text));
        role->point = &*point;
        point->has_role = true;
    }

    std::vector<PlacedPoint*> candidates(const Role& role, std::size_t size) {
        std::vector<PlacedPoint*> found;
        for (PlacedPoint& point : points)
            if (!point.has_role && fit(role, point) >= size) found.push_back(&point);
        return found;
    }

    // Assigns points to roles that only one unassigned point fits; long phrases before short ones.
    void find_points() {
        for (std::size_t size = 3; size > 0; --size)
            for (bool again = true; std::exchange(again, false);)
                for (Role& role : roles) {
                    if (role.point) continue;
                    const auto fits = candidates(role, size);
                    if (fits.size() != 1) continue;
                    role.point = fits[0];
                    fits[0]->has_role = again = true;
                }
    }

    // Whether all roles of an optional group have points; else its roles are removed.
    bool is_kept(const Value& group) {
        const auto lacks = [&](const Role& role) { return is_role_of(group, role) && !role.point; };
        if (std::ranges::none_of(roles, lacks)) return true;
        std::erase_if(roles, [&](const Role& role) {
            if (is_role_of(group, role) && role.point) role.point->has_role = false;
            return is_role_of(group, role);
        });
        return false;
    }

    // Adds a point on the rocker's axis if none is given: the axis is normal to the plane of its other points.
    void add_rocker_axis() {
        const PlacedPoint *pivot = role_called("rocker_pivot").point,
                          *rod = role_called("pushrod_inner").point,
                          *damper = role_called("damper_rocker").point;
        if (role_called("rocker_axis").point || !pivot || !rod || !damper) return;
        const Vector3d o = pivot->at, n = (rod->at - o).cross(damper->at - o);
        if (!(n.norm() > 0)) return;
        draft.points.add(o + 50 * n.normalized(), "rocker_axis",
                         {0, "across the plane of the rocker's points"});
        draft.notes.warn({0, "rocker_axis"},
                         "the file has one point of the rocker's axis; the axis is taken to be "
                         "across the plane of its three points");
        std::erase_if(roles, [](const Role& role) { return role.name == "rocker_axis"; });
    }

    void require_points() {
        std::string missing, first;
        for (const Role& role : roles) {
            if (role.point) continue;
            if (first.empty()) first = role.name;
            std::vector<std::string> names;
            for (const auto* point : candidates(role, 1))
                names.push_back(reader::quote(point->name));
            missing +=
                fmt::format("{}{}{}", missing.empty() ? "" : ", ", role.name,
                            names.empty() ? "" : fmt::format(" ({})", fmt::join(names, " or ")));
        }
        if (missing.empty()) return;
        std::vector<std::string> rest;
        for (const PlacedPoint& point : points)
            if (!point.has_role) rest.push_back(reader::quote(point.name));
        fail("--as " + options.as,
             fmt::format("no point for {}; name it with --role {}=POINT; points without a role: {}",
                         missing, first,
                         rest.empty() ? "none" : fmt::format("{}", fmt::join(rest, ", "))));
    }

    // The body of the part "upright", "lower" or "upper" on which the damper or the pushrod stands.
    std::string body_of_part(const char* option, const std::string& wanted) const {
        const Value* list = entry(pattern, "parts");
        const Value* body = list ? entry(*list, wanted) : nullptr;
        if (!body)
            fail(option,
                 fmt::format("{} is not a part of {}; allowed: {}", reader::quote(wanted),
                             options.as,
                             list ? fmt::format("{}", fmt::join(list->keys, ", ")) : "none"));
        return body->text;
    }

    // Writes the entries of the template or of a group, with PART and SIDE replaced.
    void write_entries(const Value& group, const std::string& part_body) {
        for (const auto& [section, list] : draft.sections()) {
            const Value* entries =
                std::string_view(section) == "wheels" ? nullptr : entry(group, section);
            for (std::size_t k = 0; entries && k < entries->keys.size(); ++k)
                for (const std::string& side : sides_of(entries->keys[k]))
                    list->push_back({replaced(entries->keys[k], "SIDE", side),
                                     replaced(replaced(entries->items[k].text, "PART", part_body),
                                              "SIDE", side),
                                     {}});
        }
    }

    void write_points() {
        Hardpoints written(1);
        for (const Role& role : roles) {
            written.add(role.point->at, role.name, role.point->from);
            draft.notes.roles.emplace_back(role.name, role.point->from);
        }
        for (std::size_t k = 0; k < draft.points.entries().size(); ++k)
            if (const Entry& e = draft.points.entries()[k]; e.from.line == 0)
                written.add(draft.points.positions()[k], e.name, e.from);
        draft.points = std::move(written);
        // of a mirrored point and its image, one may have the role
        for (const PlacedPoint& point : points)
            if (std::ranges::none_of(roles, [&](const Role& role) {
                    return role.point->from.line == point.from.line;
                }))
                draft.notes.leave_out("without a role", point.from);
    }

    void write_wheel(const std::string& side, const std::string& more) {
        const std::string prefix = side.empty() ? "" : side + "_";
        const PlacedPoint& centre = *role_called(prefix + "wheel_centre").point;
        const bool left = centre.at.y() >= 0;
        if (centre.marks.contains(left ? "right" : "left"))
            reader::fail(file, centre.from.line, centre.name,
                         fmt::format("lies on the {} in the axes of --axes; choose the axes in "
                                     "which it does not, or rename the point",
                                     left ? "left" : "right"));
        const Value* fields = side.empty() ? entry(pattern, "wheel") : entry(pattern, "wheels");
        draft.wheels.push_back(
            {side.empty() ? "wheel" : side,
             fmt::format("{{{}{}, spin_axis: {}, side: {}}}", replaced(fields->text, "SIDE", side),
                         replaced(more, "SIDE", side), left ? "y" : "-y", left ? "left" : "right"),
             {}});
    }

    Role& role_called(const std::string& name) {
        return *std::ranges::find(roles, name, &Role::name);
    }

    void run() {
        choose_points();
        const Value& groups = mechanism_table("groups");
        const Value *default_part = entry(pattern, "damper"), *list = entry(pattern, "optional");
        std::vector<const Value*> optional;
        if (!list) optional.push_back(entry(groups, "contact"));
        for (std::size_t k = 0; list && k < list->items.size(); ++k)
            optional.push_back(entry(groups, list->items[k].text));
        const bool has_rod = options.rocker || !options.pushrod.empty(),
                   may_damp = default_part || !options.damper.empty();
        if (has_rod && !options.damper.empty())
            fail("--damper", "with a rocker the damper stands on it");
        const std::string& wanted = has_rod ? options.pushrod : options.damper;
        const std::string part_body =
            has_rod || may_damp
                ? body_of_part(has_rod ? "--pushrod" : "--damper",
                               wanted.empty() && default_part ? default_part->text : wanted)
                : "";
        if (!has_rod && may_damp) optional.push_back(entry(groups, "damper"));
        add_roles(pattern);
        if (has_rod) add_roles(*entry(groups, "pushrod"));
        for (const Value* group : optional) add_roles(*group);
        for (const std::string& given : options.roles) assign(given);
        find_points();
        if (has_rod) add_rocker_axis();
        std::erase_if(optional, [&](const Value* group) { return !is_kept(*group); });
        require_points();
        write_points();
        write_entries(pattern, "");
        if (has_rod) write_entries(*entry(groups, "pushrod"), part_body);
        std::string wheel_fields;
        for (const Value* group : optional) {
            write_entries(*group, part_body);
            if (const Value* more = entry(*group, "wheel")) wheel_fields += ", " + more->text;
        }
        if (!options.rates.empty()) add_rates(options.rates, draft);
        const bool has_both_wheels = entry(pattern, "wheels");
        for (const std::string& side : sides_of(has_both_wheels ? "SIDE" : ""))
            write_wheel(side, wheel_fields);
        draft.branches.insert(draft.branches.begin(), {"travel", travel(has_both_wheels), {}});
        draft.title += fmt::format(", {}", reader::small_letters(entry(pattern, "title")->text));
        draft.mirror.reset();
        if (options.both_wheels && has_both_wheels)
            fail("--both-wheels", fmt::format("{} has both", options.as));
        if (options.both_wheels) add_other_wheel();
    }

    // Adds the other wheel as a mirror image: all names but those of the rack and an anti-roll bar get the
    // wheel's side in front.
    void add_other_wheel() {
        Entry& wheel = draft.wheels.front();
        const bool left = wheel.fields.ends_with("side: left}");
        const std::string side = left ? "left" : "right", of_side = side + "_";
        std::set<std::string> names;
        std::vector<std::vector<Entry>*> lists{&draft.points.entries()};
        for (const auto& [section, list] : draft.sections())
            if (list != &draft.branches && list != &draft.wheels) lists.push_back(list);
        for (const auto* list : lists)
            for (const Entry& item : *list)
                if (item.name != "rack" && item.name != "antiroll_bar") names.insert(item.name);
        const auto renamed = [&](std::string_view fields) {
            std::string text;
            for (std::size_t n = 0; !fields.empty(); fields.remove_prefix(n)) {
                for (n = 0; n < fields.size() && (reader::is_word(fields[n]) || fields[n] == '.');)
                    ++n;
                const std::string word(fields.substr(0, n));
                const bool is_key = n < fields.size() && fields[n] == ':';
                text += !is_key && names.contains(word) ? of_side + word : word;
                if (n == 0) text += fields[n++];
            }
            return replaced(text, "at_wheel: true", "at_wheel: " + side);
        };
        for (auto* list : lists)
            for (Entry& item : *list) {
                if (item.name == "rack")
                    item.fields = replaced(item.fields, "tie_rod_inner", "middle");
                if (names.contains(item.name)) item.name = of_side + item.name;
                item.fields = renamed(item.fields);
            }
        const auto rod = std::ranges::find(roles, "tie_rod_inner", &Role::name);
        if (rod != roles.end() &&
            std::ranges::find(draft.bodies, "rack", &Entry::name) != draft.bodies.end())
            draft.points.add({rod->point->at.x(), 0, rod->point->at.z()}, "middle",
                             {0, "of the rack"});
        wheel = {side, renamed(wheel.fields), {}};
        draft.mirror = left ? "left -> right" : "right -> left";
        for (Entry& branch : draft.branches)
            branch.fields = replaced(
                replaced(branch.fields, "drive: travel", "drive: [left.travel, right.travel]"),
                "{travel: 0}", "{left.travel: 0, right.travel: 0}");
        draft.branches.push_back(
            {"opposite",
             entry(*entry(*entry(mechanism_table("templates"), "live_axle"), "branches"),
                   "opposite")
                 ->text,
             {}});
    }

    // The branch `travel`. Where rigid links leave an axle one degree of freedom, the left wheel is driven and
    // there is no roll.
    std::string travel(bool both) {
        const char* drive = "travel";
        if (both) {
            int freedoms = 6 * static_cast<int>(draft.bodies.size());
            for (const Entry& joint : draft.joints)
                freedoms -= joint.fields.find("distance") != joint.fields.npos    ? 1
                            : joint.fields.find("spherical") != joint.fields.npos ? 3
                                                                                  : 5;
            drive = freedoms > 1 ? "[left.travel, right.travel]" : "left.travel";
            if (freedoms <= 1) {
                draft.branches.clear();
                draft.notes.warn({0, "travel"},
                                 "the rigid links leave the axle one motion: the left wheel is "
                                 "driven and the right one follows; there is no roll");
            }
        }
        return fmt::format("{{drive: {}, from: -30, to: 30, steps: 60}}", drive);
    }
};

}  // namespace

const Value& mechanism_table(std::string_view name) {
    static const Value file = reader::parse_yaml(embedded_mechanism[0].text, "mechanisms.yaml");
    return *entry(file, name);
}

const std::vector<std::string>& mechanisms() { return mechanism_table("templates").keys; }

std::string mechanism_called(std::string_view words) {
    const std::string text = reader::small_letters(words);
    const Value& table = mechanism_table("templates");
    for (std::size_t k = 0; k < table.keys.size(); ++k)
        for (const Value& name : entry(table.items[k], "called")->items)
            if (text.find(name.text) != text.npos) return table.keys[k];
    return "";
}

void make_mechanism(const std::string& file, const Options& options, Draft& draft) {
    const Value* pattern = entry(mechanism_table("templates"), options.as);
    if (!pattern)
        fail(file, 0, "--as", "{} is not a mechanism{}", reader::quote(options.as),
             reader::did_you_mean(options.as, mechanisms(), "allowed"));
    MechanismMaker{file, options, draft, *pattern}.run();
}

}  // namespace elastocheck::importer
