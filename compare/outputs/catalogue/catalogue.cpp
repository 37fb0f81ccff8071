#include "compare/outputs/catalogue/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compare/outputs/catalogue/subject.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

std::vector<Entry> whole_catalogue() {
    std::vector<Entry> entries;
    add_angles(entries);
    const std::size_t rates = entries.size();
    add_rates(entries);
    const std::size_t definitions = entries.size();
    add_angle_definitions(entries);
    const std::size_t rate_definitions = entries.size();
    add_rate_definitions(entries);
    for (std::size_t e = 0; e < entries.size(); ++e) {
        entries[e].on_request = e >= definitions;
        if ((e >= rates && e < definitions) || e >= rate_definitions)
            entries[e].kind = ChannelKind::characteristic;
    }
    return entries;
}

// Whether a model has what all owners of the kind need; conditions on one wheel are in is_owner().
bool has_owners(const Model& model, Owner owner) {
    const auto steers = [&](bool by_angle) {
        const int joint = steering_joint(model);
        return joint >= 0 && drives_an_angle(model, joint) == by_angle;
    };
    const auto is_at = [&](Axle axle) { return model.vehicle && model.vehicle->axle == axle; };
    switch (owner) {
        case Owner::steered_wheel: return steering_joint(model) >= 0;
        case Owner::wheel_on_rack: return steers(false);
        case Owner::wheel_on_column: return steers(true);
        case Owner::hand_wheel: return !model.wheels.empty() && rack_per_hand_wheel(model) != 0;
        case Owner::wheel_of_vehicle: return model.vehicle.has_value();
        case Owner::front_wheel: return is_at(Axle::front);
        case Owner::rear_wheel: return is_at(Axle::rear);
        case Owner::wheel_of_axle:
        case Owner::axle: return is_axle(model);
        case Owner::wheel_without_axle: return !is_axle(model);
        case Owner::two_wheels: return model.wheels.size() == 2;
        case Owner::front_axle: return is_axle(model) && is_at(Axle::front);
        default: return !model.wheels.empty() || owner == Owner::spring || owner == Owner::damper;
    }
}

bool is_owner(const Wheel& wheel, Owner owner) {
    switch (owner) {
        case Owner::rolling_wheel: return wheel.rolls();
        case Owner::wheel_with_fixed_patch: return !wheel.rolls();
        case Owner::wheel_with_steering_axis: return wheel.steering_axis.has_value();
        case Owner::wheel_on_tyre: return wheel.tyre_rate > 0;
        default: return true;
    }
}

std::vector<Channel> rates(const Model& model, bool on_request) {
    std::vector<Channel> list;
    if (model.wheels.empty()) return list;
    for (const Entry& entry : catalogue())
        if (entry.kind == ChannelKind::characteristic && entry.on_request == on_request)
            for (const NamedOwner& owner : owners(model, entry.owner))
                list.push_back(channel_of(model, entry, owner));
    return list;
}

const Entry* entry_of(const Channel& channel) {
    const auto* catalogued = std::get_if<Catalogued>(&channel.reads);
    return catalogued == nullptr ? nullptr : catalogued->entry;
}

}  // namespace

const std::vector<Entry>& catalogue() {
    static const std::vector<Entry> entries = whole_catalogue();
    return entries;
}

std::vector<NamedOwner> owners(const Model& model, Owner owner) {
    std::vector<NamedOwner> list;
    if (!has_owners(model, owner)) return list;
    switch (owner) {
        case Owner::wheels:
        case Owner::hand_wheel:
        case Owner::two_wheels:
        case Owner::axle:
        case Owner::front_axle: list.push_back({"", 0}); break;
        case Owner::spring:
            for (std::size_t k = 0; k < model.elastics.size(); ++k)
                if (const Elastic& elastic = model.elastics[k];
                    member<ScalarLaw>(elastic.kind) != nullptr &&
                    elastic.written_as != WrittenAs::stop)
                    list.push_back({elastic.name, k});
            break;
        case Owner::damper:
            for (std::size_t k = 0; k < model.dampers.size(); ++k)
                list.push_back({model.dampers[k].name, k});
            break;
        default:
            for (std::size_t w = 0; w < model.wheels.size(); ++w)
                if (is_owner(model.wheels[w], owner)) list.push_back({model.wheels[w].name, w});
    }
    return list;
}

Channel channel_of(const Model& model, const Entry& entry, const NamedOwner& owner) {
    Reads reads = Catalogued{&entry, owner.k};
    if (entry.point != nullptr) reads = Coordinate{entry.point(model.wheels[owner.k]), entry.axis};
    return {.name = owner.name + (owner.name.empty() ? "" : ".") + entry.name,
            .unit = entry.unit,
            .main = entry.properties.is_main,
            .reads = std::move(reads),
            .definition = fmt::format(fmt::runtime(entry.definition), owner.name),
            .undefined = entry.undefined};
}

std::vector<const Entry*> definitions() {
    std::vector<const Entry*> list;
    for (const bool from_states : {true, false})
        for (const Entry& entry : catalogue())
            if (entry.name.find('@') != entry.name.npos &&
                (entry.kind != ChannelKind::characteristic) == from_states)
                list.push_back(&entry);
    return list;
}

namespace {
template <class T>
std::vector<T> sorted_by_rank(std::vector<std::pair<int, T>> ranked) {
    std::ranges::sort(ranked, {}, &std::pair<int, T>::first);
    std::vector<T> list;
    for (auto& [rank, entry] : ranked) list.push_back(std::move(entry));
    return list;
}
}  // namespace

std::vector<CurveOfFigure> figures_over(DrawnAbscissa abscissa) {
    std::vector<std::pair<int, CurveOfFigure>> ranked;
    for (const Entry& entry : catalogue())
        for (const Drawing& drawing : entry.properties.drawings)
            if (drawing.abscissa == abscissa)
                ranked.push_back({drawing.rank,
                                  {entry.name, drawing.title, drawing.sign, drawing.presentation,
                                   entry.kind != ChannelKind::characteristic}});
    auto list = sorted_by_rank(std::move(ranked));
    // a name may have entries of several owners
    const auto duplicates = std::ranges::unique(list, {}, &CurveOfFigure::name);
    list.erase(duplicates.begin(), duplicates.end());
    return list;
}

std::vector<std::string> first_live_figures(int LiveRank::*branch_kind) {
    std::vector<std::pair<int, std::string>> ranked;
    for (const Entry& entry : catalogue())
        if (const int rank = entry.properties.live_rank.*branch_kind; rank > 0)
            ranked.push_back({rank, entry.name});
    return sorted_by_rank(std::move(ranked));
}

std::string_view without_owner(std::string_view output) {
    const auto dot = output.rfind('.', std::min(output.find('@'), output.size()));
    return output.substr(dot == output.npos ? 0 : dot + 1);
}
std::string figure_of(std::string_view output) {
    const std::string_view figure = without_owner(output);
    return std::string(figure.substr(0, figure.find('@')));
}

const Entry* find_entry(std::string_view output) {
    const auto found = std::ranges::find(catalogue(), without_owner(output), &Entry::name);
    return found == catalogue().end() ? nullptr : &*found;
}

const Entry* find_by_heading(std::string_view heading) {
    for (const Entry& entry : catalogue())
        for (std::string_view rest = entry.properties.rig_headings; !rest.empty();) {
            const std::string_view candidate = rest.substr(0, rest.find(", "));
            if (candidate == heading) return &entry;
            rest.remove_prefix(std::min(candidate.size() + 2, rest.size()));
        }
    return nullptr;
}

bool is_figure(const Channel& channel, std::string_view figure) {
    const Entry* entry = entry_of(channel);
    return entry != nullptr && entry->name == figure;
}
bool needs_free_response(const Channel& channel) {
    const Entry* entry = entry_of(channel);
    return entry != nullptr && entry->kind == ChannelKind::characteristic &&
           (entry->owner == Owner::wheel_on_tyre || entry->unit == Unit::newton_per_mm ||
            entry->properties.needs_free_response);
}
bool is_swing_arm(const Channel& channel) {
    const Entry* entry = entry_of(channel);
    return entry != nullptr && entry->properties.swing_arm;
}
bool is_position(const Channel& channel) {
    const Entry* entry = entry_of(channel);
    return entry != nullptr && entry->properties.is_position;
}

bool reads_steering_axis(const Channel& channel) {
    const Entry* entry = entry_of(channel);
    return entry != nullptr && entry->owner == Owner::wheel_with_steering_axis &&
           !entry->on_request;
}

Channel figure_channel(const Model& model, std::string_view figure, std::size_t wheel) {
    return channel_of(model, *find_entry(figure), {model.wheels[wheel].name, wheel});
}

std::vector<Channel> characteristics(const Model& model) { return rates(model, false); }

std::vector<Channel> definition_channels(const Model& model) {
    std::vector<Channel> list;
    for (const Entry& entry : catalogue()) {
        if (!entry.on_request || entry.kind == ChannelKind::characteristic) continue;
        for (const NamedOwner& owner : owners(model, entry.owner)) {
            // straight ahead, where a scene begins, Ackermann's figures are undefined
            const double drawn = entry.formula({model, nullptr, owner.k});
            if (!std::isnan(drawn) && (drawn != undefined || !entry.undefined.empty()))
                list.push_back(channel_of(model, entry, owner));
        }
    }
    std::ranges::move(rates(model, true), std::back_inserter(list));
    for (auto& channel : characteristics(model))
        if (channel.name.find('@') != channel.name.npos) list.push_back(std::move(channel));
    return list;
}

std::vector<Channel> definitions_of(std::span<const Channel> defined, const std::string& figure) {
    std::vector<Channel> list;
    std::string own = figure;  // without the loading of an axle, "@parallel"
    if (const Entry* entry = find_entry(figure); entry != nullptr && !entry->on_request)
        own.resize(std::min(own.find('@'), own.size()));
    for (const Channel& channel : defined) {
        const std::string base = channel.name.substr(0, channel.name.find('@'));
        // a figure of the axle, "toe@axle", may stand for that of either wheel
        if (channel.name != figure && (base == own || own.ends_with("." + base)))
            list.push_back(channel);
    }
    return list;
}

std::vector<DefinitionSet> definition_sets() {
    std::vector<DefinitionSet> sets{
        {"iso8855",
         "ISO 8855:2011, where it has more figures than the outputs without @, which are its own",
         {}},
        {"sae",
         "SAE J670e:1976: offsets in side and front elevation, arms to the centre of tire "
         "contact, the roll center by forces",
         {}},
        {"planes",
         "drawings in front and side view: instant centres by the planes of the wishbones",
         {}}};
    for (DefinitionSet& set : sets)
        for (const Entry* entry : definitions())
            if (entry->properties.definition_set == set.name) set.members.push_back(entry->name);
    return sets;
}

double value_of(const Model& model, const Catalogued& catalogued, const Equilibrium& state,
                const WheelResponse& response) {
    if (response.blocked) return undefined;
    return response.why_not.empty()
               ? catalogued.entry->formula({model, &state, catalogued.of, nullptr, &response})
               : nan;
}

}  // namespace elastocheck::compare
