#include "models/reader/definitions/mirror.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "models/kinds.hpp"
#include "models/laws.hpp"
#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/characters.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reader {
namespace {

// A letter of any language: ASCII, or any byte of a longer UTF-8 character.
bool is_any_letter(char c) { return is_letter(c) || static_cast<unsigned char>(c) >= 0x80; }

bool is_all_letters(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, is_any_letter);
}

bool any_name_is_mirrored(const Mirror& mirror, const Cursor& scene) {
    for (const Value& section : scene.value->items)
        for (const std::string& name : section.keys)
            if (mirrored_name(mirror, name)) return true;
    return false;
}

void collect_words(const Value& value, std::set<std::string>& words) {
    if (value.kind == Value::Kind::scalar) words.insert(value.text);
    for (const Value& item : value.items) collect_words(item, words);
}

BodyId twin(BodyId body, const Definitions& defs) {
    return body == ground ? ground : defs.twin_of[static_cast<std::size_t>(body)];
}

// s_local of the mirrored point: from p' = S p, s' = S (r + s) - r' = S s + (S r - r'). The bracket is
// exactly 0 unless the body is shared and its origin is off the plane.
Vector3 twin_place(BodyId body, const Vector3& s_local, const Definitions& defs) {
    if (body == ground) return reflected(s_local);
    const auto origin = [&](BodyId b) { return defs.bodies[static_cast<std::size_t>(b)].design.r; };
    return reflected(s_local) + (reflected(origin(body)) - origin(twin(body, defs)));
}

// A' = S A S: the vector part v of the quaternion is parallel to the rotation axis, an axial vector, so
// that v' = -S v.
Marker twin(const Marker& m, const Definitions& defs) {
    const Vector3 v = -reflected(Vector3(m.A_local.vec()));
    return {twin(m.body, defs), twin_place(m.body, m.s_local, defs),
            Quaternion(m.A_local.w(), v.x(), v.y(), v.z())};
}

}  // namespace

Mirror read_mirror(const Cursor& field, const Cursor& scene) {
    const std::string_view text = field.text("a mirror, like left -> right");
    const std::size_t arrow = text.find("->");
    Mirror mirror;
    if (arrow != std::string_view::npos)
        mirror = {std::string(trimmed(text.substr(0, arrow))),
                  std::string(trimmed(text.substr(arrow + 2)))};
    if (!is_all_letters(mirror.from) || !is_all_letters(mirror.to) || mirror.from == mirror.to)
        field.fail(fmt::format(
            "{} is not a mirror; expected two different words of letters, like left -> right",
            field.found()));
    if (!any_name_is_mirrored(mirror, scene))
        field.fail(
            fmt::format("nothing to mirror: no name contains the word {}", quote(mirror.from)));
    return mirror;
}

std::optional<std::string> mirrored_name(const Mirror& mirror, std::string_view name) {
    std::string result;
    bool found = false;
    while (!name.empty()) {
        const auto end = is_any_letter(name.front()) ? std::ranges::find_if_not(name, is_any_letter)
                                                     : std::ranges::find_if(name, is_any_letter);
        const std::string_view piece = name.substr(0, static_cast<std::size_t>(end - name.begin()));
        found = found || piece == mirror.from;
        result += piece == mirror.from ? std::string_view(mirror.to) : piece;
        name.remove_prefix(piece.size());
    }
    return found ? std::optional(result) : std::nullopt;
}

bool is_twin(const Mirror& mirror, std::string_view name) {
    return mirrored_name({mirror.to, mirror.from}, name).has_value();
}

std::optional<std::string> twin_name(const Mirror& mirror, const std::string& name,
                                     const Cursor& section) {
    const auto twin = mirrored_name(mirror, name);
    if (twin)
        if (const auto twin_entry = section.optional(*twin))
            twin_entry->fail(
                fmt::format("the mirror generates it from {}; remove one of the two", quote(name)));
    return twin;
}

void require_both_sides(const Cursor& section, const Definitions& defs) {
    if (!defs.mirror) return;
    for (const auto& [name, field] : section.entries()) {
        if (mirrored_name(*defs.mirror, name)) continue;
        std::set<std::string> words;
        collect_words(*field.value, words);
        for (const std::string& word : words) {
            const auto twin = mirrored_name(*defs.mirror, word);
            const bool is_reference = defs.points.contains(word) || defs.body_ids.contains(word);
            if (!twin || !is_reference || words.contains(*twin)) continue;
            field.fail(
                fmt::format("shared by both sides, since its name does not contain {}, but refers "
                            "to {} and not to {}",
                            quote(defs.mirror->from), quote(word), quote(*twin)));
        }
    }
}

Vector3 reflected(const Vector3& v) { return {v.x(), 0 - v.y(), v.z()}; }  // 0, not -0, for 0

Vector6 reflected(const Vector6& v) {
    Vector6 result;
    result << reflected(Vector3(v.head<3>())), -reflected(Vector3(v.tail<3>()));
    return result;
}

Point twin(const Point& p, const Definitions& defs) {
    return {twin(p.body, defs), twin_place(p.body, p.s_local, defs)};
}

namespace {

// The members of the twin; lengths, angles and formulations are unchanged.
template <class K>
K twin_of(K kind, const Definitions& defs) {
    Vector6 signs;
    for (int k = 0; k < 6; ++k) signs[k] = reflected(Vector6(Vector6::Unit(k)))[k];
    each_member(
        kind,
        overloaded{
            [&](BodyId& body) { body = twin(body, defs); }, [&](Point& p) { p = twin(p, defs); },
            [&](Direction& u) {
                u = {twin(u.body, defs), reflected(u.u_local)};
            },
            [&](RotationAxis<Direction> u) {
                u.direction = {twin(u.direction.body, defs), -reflected(u.direction.u_local)};
            },
            [&](Marker& m) { m = twin(m, defs); },
            [&](SpatialLaw& law) { law = with_signs(law, signs); },
            [&](ForceAndMoment<Vector6> w) { w.value = reflected(w.value); },
            [&](Deformation<Vector6> e) { e.value = reflected(e.value); },
            [&](LoadVector<Vector3> v) {
                v.value = reflected(v.value);
                if (v.is_moment) v.value = -v.value;
            }});
    return kind;
}

}  // namespace

JointKind twin(const JointKind& joint, const Definitions& defs) { return twin_of(joint, defs); }
ElasticKind twin(const ElasticKind& element, const Definitions& defs) {
    return twin_of(element, defs);
}
LoadKind twin(const LoadKind& load, const Definitions& defs) { return twin_of(load, defs); }

Wheel twin(const Wheel& wheel, const Definitions& defs) {
    std::optional<SteeringAxis> axis = wheel.steering_axis;
    if (axis) axis = {twin(axis->lower, defs), twin(axis->upper, defs)};
    return {.name = wheel.name,
            .body = twin(wheel.body, defs),
            .centre_local = twin_place(wheel.body, wheel.centre_local, defs),
            .contact = twin(wheel.contact, defs),
            .spin_axis_local = reflected(wheel.spin_axis_local),
            .side = -wheel.side,
            .tyre_rate = wheel.tyre_rate,
            .steering_axis = axis};
}

}  // namespace elastocheck::reader
