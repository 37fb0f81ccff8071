#include "reports/tables/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "compare/outputs/catalogue/catalogue.hpp"

namespace elastocheck::reports {
namespace {

using compare::Channel;
using compare::Unit;

using Component = compare::Block::Component;

const char* si_symbol(Unit unit) {
    switch (unit) {
        case Unit::mm: return "m";
        case Unit::deg: return "rad";
        case Unit::newton_per_mm: return "N/m";
        case Unit::deg_per_kN: return "rad/N";
        case Unit::deg_per_100Nm: return "rad/(N·m)";
        default: return compare::symbol(unit);
    }
}
// Unit of a compliance in degrees, and the factor to it from the unit of the output.
struct InDegrees {
    double factor;
    const char* symbol;
};
std::optional<InDegrees> in_degrees(Unit unit) {
    if (unit == Unit::deg_per_kN) return InDegrees{1e-3, "deg/N"};
    if (unit == Unit::deg_per_100Nm) return InDegrees{1e-2, "deg/(N·m)"};
    return std::nullopt;
}

// The outputs of each wheel whose entry in the catalogue has a property, in its order.
std::vector<WheelOutput> chosen(const Model& model, bool (*has)(const compare::Entry&)) {
    std::vector<Channel> all = compare::channels(model);
    std::ranges::move(compare::characteristics(model), std::back_inserter(all));
    std::ranges::move(compare::definition_channels(model), std::back_inserter(all));
    std::vector<WheelOutput> list;
    for (const Wheel& wheel : model.wheels)
        for (const compare::Entry& entry : compare::catalogue()) {
            if (!has(entry)) continue;
            const std::string name = (wheel.name.empty() ? "" : wheel.name + ".") + entry.name;
            const auto at = std::ranges::find(all, name, &Channel::name);
            if (at == all.end()) continue;
            const char* side = wheel.side > 0 ? "left" : "right";
            list.push_back({*at, entry.name, wheel.name.empty() ? side : wheel.name, wheel.side});
        }
    return list;
}

std::string number_or_nan(double value) {
    return std::isfinite(value) ? fmt::format("{:.12g}", value + 0.0) : "NaN";
}
std::string in_quotes(std::string_view text) {
    std::string cell = "\"";
    for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
    return cell + "\"";
}

// The variable in the axes of the file: travel counts along its z axis.
Breakpoints turned(Breakpoints points, BlockAxes axes) {
    if (points.is_travel && axes == BlockAxes::sae)
        for (double& value : points.values) value = 0.0 - value;
    return points;
}
// Positions of the values in ascending order.
std::vector<std::size_t> ascending(const Breakpoints& points) {
    std::vector<std::size_t> order(points.values.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    if (order.size() > 1 && points.values.front() > points.values.back())
        std::ranges::reverse(order);
    return order;
}
std::string described(const Breakpoints& points, BlockAxes axes) {
    const char* how =
        points.is_travel
            ? (axes == BlockAxes::sae
                   ? "wheel centre against the body along z, downwards: jounce is negative"
                   : "wheel centre against the body along z, upwards: jounce is positive")
            : "as the scene counts it";
    return fmt::format("{},{},{}", in_quotes(points.name), points.unit, in_quotes(how));
}

}  // namespace

std::vector<WheelOutput> block_outputs(const Model& model) {
    return chosen(model,
                  [](const compare::Entry& e) { return e.properties.block.name != nullptr; });
}

std::vector<WheelOutput> compliance_outputs(const Model& model) {
    return chosen(model, [](const compare::Entry& e) { return e.properties.compliance; });
}

std::string blocks_csv(const KCBlocks& blocks, BlockAxes axes) {
    const bool sae = axes == BlockAxes::sae;
    std::string text = fmt::format("{}: {}\n# axes {}; SI units; NaN: not defined there\n",
                                   blocks_head, blocks.scene,
                                   sae ? "sae: x forward, y right, z down (SAE J670)"
                                       : "iso: x forward, y left, z up (ISO 8855)");
    const Breakpoints x = turned(blocks.x, axes), y = turned(blocks.y, axes);
    const bool x_rows = y.name.empty() || !y.is_travel;
    const Breakpoints &rows = x_rows ? x : y, &columns = x_rows ? y : x;
    const auto row_order = ascending(rows);
    const auto column_order =
        columns.name.empty() ? std::vector<std::size_t>{0} : ascending(columns);
    for (std::size_t c = 0; c < blocks.outputs.size(); ++c) {
        const auto& [channel, output, wheel, side] = blocks.outputs[c];
        const compare::Block& quantity = compare::find_entry(output)->properties.block;
        // outwards is +y of ISO on the left wheel
        double sign = quantity.outwards && side < 0 ? -1 : 1;
        if (sae && quantity.component != Component::none) sign = -sign;
        const double factor = sign / compare::in_unit(channel.unit);
        text +=
            fmt::format("\nblock,{}.{}\nquantity,{}\nwheel,{}\nunit,{}\ndefinition,{}\nrows,{}\n",
                        wheel, quantity.name, quantity.name, wheel, si_symbol(channel.unit),
                        in_quotes(quantity.definition ? quantity.definition : channel.definition),
                        described(rows, axes));
        if (columns.name.empty())
            text += "columns,none\ndata,value\n";
        else {
            text += fmt::format("columns,{}\ndata", described(columns, axes));
            for (const std::size_t k : column_order) text += "," + number_or_nan(columns.values[k]);
            text += "\n";
        }
        for (const std::size_t r : row_order) {
            text += number_or_nan(rows.values[r]);
            for (const std::size_t k : column_order) {
                const auto& point = x_rows ? blocks.values[k][r] : blocks.values[r][k];
                text += "," + number_or_nan(factor * point[c]);
            }
            text += "\n";
        }
    }
    text +=
        "\n# compliance at the design position, per wheel: toe positive towards toe-in, camber "
        "where the top leans out, in either axes\n"
        "coefficient,wheel,value,unit,in degrees,unit,definition\n";
    for (std::size_t c = 0; c < blocks.compliance.size(); ++c) {
        const auto& [channel, output, wheel, side] = blocks.compliance[c];
        const double value = blocks.coefficients[c];
        const auto degrees = in_degrees(channel.unit);
        text += fmt::format("{},{},{},{},{},{},{}\n", output, wheel,
                            number_or_nan(value / compare::in_unit(channel.unit)),
                            si_symbol(channel.unit),
                            degrees ? number_or_nan(value * degrees->factor) : "",
                            degrees ? degrees->symbol : "", in_quotes(channel.definition));
    }
    return text;
}

}  // namespace elastocheck::reports
