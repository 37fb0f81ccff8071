#include "reports/tables/elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "models/kinds.hpp"

namespace elastocheck::reports {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr std::array components{"x", "y", "z", "rx", "ry", "rz"};

// Display units of a deformation and its rate.
struct RateUnits {
    double length;  // [m] or [rad] per unit
    const char* length_name;
    double rate;  // [N/m] or [N·m/rad] per unit
    const char* rate_name;
};
constexpr RateUnits lengths{1e-3, "mm", 1e3, "N/mm"}, angular{degree, "deg", 1 / degree, "N·m/deg"};

std::string rate_words(double k, const RateUnits& s) {
    return fmt::format("{:.4g} {}", k / s.rate, s.rate_name);
}

bool is_free(const std::array<double, 4>& piece) {
    return std::ranges::all_of(piece, [](double c) { return c == 0; });
}

std::string range_words(const Curve& curve, const RateUnits& s) {
    return fmt::format("curve from {:.4g} to {:.4g} {}, {}", curve.knots.front() / s.length,
                       curve.knots.back() / s.length, s.length_name,
                       curve.known_outside ? "straight beyond" : "undefined beyond");
}

// Where a curve without force on one side makes contact, and its law beyond.
struct Contact {
    double touches;  // ℓ - ℓ₀ [m]
    bool longer;     // it makes contact as it grows longer
    std::array<double, 4> law;
};
std::optional<Contact> contact_of(const Curve& u) {
    const bool open_short = is_free(u.pieces.front()), open_long = is_free(u.pieces.back());
    if (open_short == open_long) return std::nullopt;
    std::size_t n = 0;  // end of the force-free side
    while (n < u.knots.size() && is_free(open_short ? u.pieces[n] : u.pieces[u.knots.size() - n]))
        ++n;
    return open_short ? Contact{u.knots[n - 1], true, u.pieces[n]}
                      : Contact{u.knots[u.knots.size() - n], false, u.pieces[u.knots.size() - n]};
}

std::string spring_words(const ScalarLaw& law, WrittenAs written_as) {
    return std::visit(
        overloaded{[](const LinearRate& u) { return "axial spring, " + rate_words(u.k, lengths); },
                   [&](const Curve& u) {
                       const auto contact = contact_of(u);
                       if (!contact) return "axial spring, " + range_words(u, lengths);
                       const auto& [touches, longer, piece] = *contact;
                       const bool straight = piece[2] == 0 && piece[3] == 0;
                       if (written_as == WrittenAs::itself)
                           return fmt::format(
                               "axial spring with loose seats, {}",
                               straight ? rate_words(piece[1], lengths) : range_words(u, lengths));
                       return fmt::format("stop, touches when {:.4g} mm {}, {}",
                                          1e3 * std::abs(touches), longer ? "longer" : "shorter",
                                          straight ? rate_words(std::abs(piece[1]), lengths)
                                                   : range_words(u, lengths));
                   }},
        law);
}

// Components with stiffness, and those with curves.
struct Resisted {
    std::vector<std::size_t> all, curves;
};
Resisted resisted(const SpatialLaw& law) {
    Resisted motion;
    const auto add = [&](std::size_t k, bool is_curve) {
        motion.all.push_back(k);
        if (is_curve) motion.curves.push_back(k);
    };
    std::visit(overloaded{[&](const LinearStiffness& u) {
                              for (std::size_t k = 0; k < 6; ++k)
                                  if (!u.K.row(static_cast<Eigen::Index>(k)).isZero(0))
                                      add(k, false);
                          },
                          [&](const PerAxis& u) {
                              for (std::size_t k = 0; k < 6; ++k)
                                  std::visit(
                                      overloaded{[&](const LinearRate& l) {
                                                     if (l.k != 0) add(k, false);
                                                 },
                                                 [&](const Curve& l) {
                                                     if (!std::ranges::all_of(l.pieces, is_free))
                                                         add(k, true);
                                                 }},
                                      u.axis[k]);
                          }},
               law);
    return motion;
}

std::string law_words(const SpatialLaw& law, std::size_t k, const RateUnits& s) {
    return std::visit(
        overloaded{[&](const LinearStiffness& u) {
                       const auto i = static_cast<Eigen::Index>(k);
                       return rate_words(u.K(i, i), s);
                   },
                   [&](const PerAxis& u) {
                       return std::visit(
                           overloaded{[&](const LinearRate& l) { return rate_words(l.k, s); },
                                      [&](const Curve& l) { return range_words(l, s); }},
                           u.axis[k]);
                   }},
        law);
}

std::string formulation_words(const Formulation& f) {
    std::string text;
    const auto add = [&](bool differs, const char* words) {
        if (differs) text += std::string(", ") + words;
    };
    add(f.frame == Formulation::Frame::on_j, "frame on j");
    add(f.frame == Formulation::Frame::middle, "frame in the middle");
    add(f.angles == Formulation::Angles::cardan, "Cardan angles");
    add(f.angles == Formulation::Angles::projected, "projected angles");
    add(!f.conjugate, "forces along its axes, not conjugate (no energy)");
    add(!f.offset_moment, "without the moment of the offset (no energy)");
    return text;
}

// Formulations of bushings as in the scene, before compile() exchanged markers.
using Formulations = std::unordered_map<std::string, Formulation>;
Formulations written_formulations(const Scene& scene) {
    Formulations written;
    for (const auto& elastic : scene.elastics)
        if (const auto* formulation = member<Formulation>(elastic.kind))
            written.emplace(elastic.name, *formulation);
    return written;
}

bool is_beam(const Elastic& elastic) {
    const auto* formulation = member<Formulation>(elastic.kind);
    return formulation != nullptr && formulation->frame == Formulation::Frame::middle &&
           matrix_of(*member<SpatialLaw>(elastic.kind)) != nullptr;
}

std::string bushing_words(const Formulations& written, const Elastic& elastic,
                          const SpatialLaw& law) {
    const Resisted axes = resisted(law);
    if (elastic.written_as == WrittenAs::tyre) {
        PerAxis pushed = std::get<PerAxis>(law);
        pushed.axis[2] = LinearRate{curve_of(pushed.axis[2])->pieces.front()[1]};
        return fmt::format("tyre, {}, only pushes, active on the branches that drive its road",
                           law_words(pushed, 2, lengths));
    }
    if (axes.all == std::vector<std::size_t>{5})
        return "torsion spring, " + law_words(law, 5, angular);
    std::string text = is_beam(elastic) ? "beam" : "bushing";
    if (!is_beam(elastic)) {
        const auto as_written = written.find(elastic.name);
        text += formulation_words(as_written != written.end() ? as_written->second
                                                              : *member<Formulation>(elastic.kind));
    }
    for (const std::size_t k : axes.curves)
        text +=
            fmt::format(", {}: {}", components[k], law_words(law, k, k < 3 ? lengths : angular));
    bool is_offset = false;
    each_member(elastic.kind,
                [&](Deformation<const Vector6> e) { is_offset = !e.value.isZero(0); });
    if (is_offset) text += ", with an undeformed position other than the design position";
    return text;
}

// "antiroll" and 3 for "antiroll.3"; 0 without a number.
std::pair<std::string, int> stem(const std::string& name) {
    const auto dot = name.rfind('.');
    int number = 0;
    if (dot == name.npos) return {name, 0};
    const char *begin = name.data() + dot + 1, *end = name.data() + name.size();
    if (std::from_chars(begin, end, number).ptr != end) return {name, 0};
    return {name.substr(0, dot), number};
}

}  // namespace

std::optional<double> clearance_of(const ScalarLaw& law) {
    const Curve* curve = curve_of(law);
    const auto contact = curve != nullptr ? contact_of(*curve) : std::nullopt;
    return contact ? std::optional(std::abs(contact->touches)) : std::nullopt;
}

std::vector<ElementLine> elements(const Scene& scene, const Model& model) {
    const auto body = [&](BodyId b) { return body_name(model, b); };
    const Formulations written = written_formulations(scene);
    std::vector<ElementLine> lines;
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const Elastic& elastic = model.elastics[k];
        const auto [i, j] = ends(elastic.kind);
        std::size_t last = k;  // of a chain
        const auto [name, number] = stem(elastic.name);
        while (number > 0 && is_beam(elastic) && last + 1 < model.elastics.size() &&
               is_beam(model.elastics[last + 1]) &&
               stem(model.elastics[last + 1].name) ==
                   std::pair{name, number + static_cast<int>(last + 1 - k)})
            ++last;
        if (last > k) {
            const Elastic& end = model.elastics[last];
            lines.push_back({fmt::format("{} ... {}", elastic.name,
                                         last - k + static_cast<std::size_t>(number)),
                             body(i) + " - " + body(ends(end.kind).j),
                             fmt::format("beam in {} segments", last - k + 1)});
            k = last;
            continue;
        }
        std::string words;
        each_member(
            elastic.kind,
            overloaded{
                [&](const ScalarLaw& law) { words = spring_words(law, elastic.written_as); },
                [&](const SpatialLaw& law) { words = bushing_words(written, elastic, law); }});
        lines.push_back({elastic.name, body(i) + " - " + body(j), words});
    }
    return lines;
}

std::vector<std::vector<double>> force_over_travel(const Model& model, const Branch& branch,
                                                   const compare::BranchComparison& solved,
                                                   const std::string& element, std::size_t wheel) {
    const auto all = compare::element_channels(model);
    const auto force = std::ranges::find(all, element + ".force", &compare::Channel::name),
               deflection =
                   std::ranges::find(all, element + ".deflection", &compare::Channel::name);
    if (force == all.end() || deflection == all.end()) return {};
    const std::vector<compare::Channel> channels{
        compare::figure_channel(model, compare::figure::travel, wheel), *force, *deflection};
    std::vector<std::vector<double>> rows;
    for (const auto& state : solved.run(compare::Leg::equilibrium).stations)
        rows.push_back(compare::evaluate(model, branch, channels, state));
    return rows;
}

}  // namespace elastocheck::reports
