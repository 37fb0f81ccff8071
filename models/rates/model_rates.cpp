#include "models/rates/model_rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "models/rates/bridge.hpp"
#include "models/rates/fields.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"
#include "models/reader/plausibility.hpp"

namespace elastocheck {
namespace {

using elastocheck_dual::Answer;
using elastocheck_dual::Archive;
using elastocheck_dual::directions;
using elastocheck_dual::Together;
using rates::archive_of;
using rates::with_numbers;

const std::string not_alone = "cannot be varied alone: ";  // + error of the reader

bool same_structure(const Archive& a, const Archive& b) {
    return a.texts == b.texts && a.wholes == b.wholes && a.values.size() == b.values.size();
}

std::vector<double> column(const Archive& archive, std::size_t direction) {
    std::vector<double> result;
    for (const auto& rates : archive.rates) result.push_back(rates[direction]);
    return result;
}

bool all_finite(const std::vector<double>& x) {
    return std::ranges::all_of(x, [](double entry) { return std::isfinite(entry); });
}

// Whether the entries agree within `relative` of their size, or of a millionth of the largest.
bool agree(const std::vector<double>& a, const std::vector<double>& b, double relative) {
    double largest = 0;
    for (const double x : a) largest = std::max(largest, std::abs(x));
    for (std::size_t k = 0; k < a.size(); ++k)
        if (!(std::abs(a[k] - b[k]) <=
              relative * std::max({std::abs(a[k]), std::abs(b[k]), 1e-6 * largest})))
            return false;
    return true;
}

// The scene and the model with the numbers of type double.
struct Plain {
    const Scene& scene;
    const Model& model;
    Archive scene_data, model_data;

    Plain(const Scene& s, const Model& m)
        : scene(s), model(m), scene_data(archive_of(s)), model_data(archive_of(m)) {}

    bool has_structure_of(const Answer& answer) const {
        return same_structure(scene_data, answer.scene) && same_structure(model_data, answer.model);
    }
    bool has_values_of(const Answer& answer) const {
        constexpr double round_off = 1e-9;
        return agree(scene_data.values, answer.scene.values, round_off) &&
               agree(model_data.values, answer.model.values, round_off);
    }
};

struct Column {
    std::vector<double> scene, model;
    bool is_finite() const { return all_finite(scene) && all_finite(model); }
};
Column column(const Answer& answer, std::size_t direction) {
    return {column(answer.scene, direction), column(answer.model, direction)};
}

void fill(ModelRate& rate, const Plain& plain, const Column& column) {
    rate.scene_rate = with_numbers(plain.scene, column.scene);
    rate.rate = with_numbers(plain.model, column.model);
}

ModelRate undefined(ModelRate rate, const Plain& plain, std::string why) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    fill(rate, plain,
         {std::vector<double>(plain.scene_data.values.size(), none),
          std::vector<double>(plain.model_data.values.size(), none)});
    rate.undefined = std::move(why);
    return rate;
}

// What is left out of one model and not of the other, for a message.
std::string difference(const Archive& plain, const Archive& other) {
    for (const auto& [has, lacks] : {std::pair{&plain, &other}, {&other, &plain}})
        for (const std::string& text : has->texts)
            if (std::ranges::find(lacks->texts, text) == lacks->texts.end())
                return fmt::format(" ({})", text);
    return "";
}

// The derivative from those to both sides, where a comparison was a tie.
ModelRate from_sides(ModelRate rate, const Plain& plain, const Answer& below, const Answer& above) {
    const bool down = below.error.empty(), up = above.error.empty();
    if (!down && !up) return undefined(std::move(rate), plain, not_alone + above.error);
    Column columns[2];
    for (const Answer* answer : {&below, &above}) {
        if (!answer->error.empty()) continue;
        if (!plain.has_structure_of(*answer))
            return undefined(std::move(rate), plain,
                             "decides at this value which parts the model has" +
                                 difference(plain.model_data, answer->model));
        if (!plain.has_values_of(*answer))
            return undefined(std::move(rate), plain, "the model jumps at this value");
        Column& its = columns[answer == &above];
        its = column(*answer, 0);
        if (!its.is_finite())
            return undefined(std::move(rate), plain, "the derivative is infinite at this value");
    }
    const auto& [left, right] = columns;
    if (down && up &&
        !(agree(left.model, right.model, 1e-9) && agree(left.scene, right.scene, 1e-9))) {
        rate =
            undefined(std::move(rate), plain, "the derivative differs on both sides of this value");
        rate.below = with_numbers(plain.model, left.model);
        rate.above = with_numbers(plain.model, right.model);
        return rate;
    }
    rate.side = down && up ? 0 : up ? 1 : -1;
    fill(rate, plain, up ? right : left);
    return rate;
}

// A branch from 0 has one side, from any other value two.
bool adds_a_side(const Plain& plain, const Model& rate) {
    for (std::size_t b = 0; b < rate.branches.size(); ++b)
        if (plain.model.branches[b].from == 0 && rate.branches[b].from != 0) return true;
    return false;
}

// The derivative in one direction of the answer; `on_side(±1)` answers for a side.
template <class OnSide>
ModelRate rate_in(const Plain& plain, const Answer& answer, std::size_t direction, ModelRate rate,
                  OnSide on_side) {
    if (answer.whole_number[direction]) return undefined(std::move(rate), plain, "a whole number");
    const Column both = column(answer, direction);
    if (answer.tie[direction] || !both.is_finite())
        rate = from_sides(std::move(rate), plain, on_side(-1), on_side(1));
    else
        fill(rate, plain, both);
    if (rate.undefined.empty() && adds_a_side(plain, rate.rate))
        return undefined(std::move(rate), plain, "0, where the branch has one side only");
    return rate;
}

void require_same(const Plain& plain, const Answer& answer) {
    if (!answer.error.empty())
        throw std::logic_error("with dual numbers the scene is not accepted: " + answer.error);
    if (!plain.has_structure_of(answer) || !plain.has_values_of(answer))
        throw std::logic_error("with dual numbers the scene is another one");
}

// The paths joined by commas, which no name contains.
Together together(std::string_view joined, const Scene& scene) {
    Together paths;
    for (bool more = true; more;) {
        const auto comma = joined.find(',');
        more = comma != joined.npos;
        const std::string path(joined.substr(0, comma));
        if (more) joined.remove_prefix(comma + 1);
        if (std::ranges::find(scene.numbers, path, &Number::path) == scene.numbers.end()) {
            std::vector<std::string> names;
            for (const Number& number : scene.numbers) names.push_back(number.path);
            throw SceneError(fmt::format("{}: the scene has no number {}{}", scene.source,
                                         reader::quote(path),
                                         reader::did_you_mean(path, names, "there")));
        }
        paths.push_back(path);
    }
    return paths;
}

// A file that was read.
struct Source {
    elastocheck_dual::File file;
    Scene scene;
};

std::vector<ModelRate> rates_of(const Source& source, std::span<const std::string> paths,
                                Detail detail) {
    const bool everything = detail == Detail::everything;
    const Model model = compile(source.scene, detail);
    const Plain plain(source.scene, model);
    std::vector<Together> changes;
    for (const std::string& path : paths) changes.push_back(together(path, source.scene));
    std::vector<ModelRate> result;
    for (std::size_t begin = 0; begin < paths.size(); begin += directions) {
        const std::size_t end = std::min(begin + directions, paths.size());
        const Answer answer = elastocheck_dual::read(
            source.file, everything, {changes.data() + begin, changes.data() + end}, 0);
        require_same(plain, answer);
        for (std::size_t k = begin; k < end; ++k)
            result.push_back(rate_in(plain, answer, k - begin, {paths[k], {}}, [&](int side) {
                return elastocheck_dual::read(source.file, everything, {changes[k]}, side);
            }));
    }
    return result;
}

elastocheck_dual::File file_of(std::string_view text, const std::string& name,
                               std::span<const Setting> settings) {
    elastocheck_dual::File file{
        .text = std::string(text), .name = name, .folder = {}, .settings = {}};
    for (const Setting& setting : settings) file.settings.emplace_back(setting.path, setting.value);
    return file;
}

Source read(const std::filesystem::path& path, std::span<const Setting> settings) {
    const reader::TextFile read = reader::read_text(path, reader::Pipes::allowed);
    if (!read.trouble.empty()) reader::fail(path.string(), 0, "", read.trouble);
    Source source{file_of(read.text, path.string(), settings), {}};
    const auto folder = path.parent_path();
    source.file.folder = folder.string();
    source.scene = reader::read_whole(read.text, source.file.name, settings, folder).scene;
    return source;
}

// The group of a number: "bushings.mount" of "bushings.mount.rates.y".
std::string_view group(std::string_view path) {
    const auto dot = path.find('.');
    return path.substr(0, path.find('.', dot == path.npos ? dot : dot + 1));
}

// Joins numbers that cannot be varied alone and can be together: two of one group and of one value.
void join(std::vector<ModelRate>& rates, const Source& source, Detail detail) {
    const auto is_open = [](const ModelRate& rate) {
        return rate.undefined.starts_with(not_alone);
    };
    const auto value = [&](const ModelRate& rate) {
        return std::ranges::find(source.scene.numbers, rate.path, &Number::path)->value;
    };
    for (std::size_t k = 0; k < rates.size(); ++k)
        for (std::size_t l = k + 1; l < rates.size() && is_open(rates[k]); ++l) {
            if (!is_open(rates[l]) || group(rates[k].path) != group(rates[l].path) ||
                value(rates[k]) != value(rates[l]))
                continue;
            const std::string both[] = {rates[k].path + "," + rates[l].path};
            auto joined = rates_of(source, both, detail);
            if (!joined.front().undefined.empty()) continue;
            rates[k] = std::move(joined.front());
            rates.erase(rates.begin() + static_cast<std::ptrdiff_t>(l));
        }
}

}  // namespace

std::vector<ModelRate> model_rates(const std::filesystem::path& file,
                                   std::span<const Setting> settings,
                                   std::span<const std::string> paths, Detail detail) {
    return rates_of(read(file, settings), paths, detail);
}

std::vector<ModelRate> model_rates(std::string_view text, const std::string& name,
                                   std::span<const Setting> settings,
                                   std::span<const std::string> paths, Detail detail) {
    return rates_of({file_of(text, name, settings), parse_scene(text, name, settings)}, paths,
                    detail);
}

std::vector<ModelRate> all_model_rates(const std::filesystem::path& file,
                                       std::span<const Setting> settings, Detail detail) {
    const Source source = read(file, settings);
    std::vector<std::string> paths;
    for (const Number& number : source.scene.numbers) paths.push_back(number.path);
    auto rates = rates_of(source, paths, detail);
    join(rates, source, detail);
    return rates;
}

ModelRate model_rate(const Scene& scene, const Scene& rate, Detail detail) {
    const bool everything = detail == Detail::everything;
    const Model model = compile(scene, detail);
    const Plain plain(scene, model);
    Archive asked = plain.scene_data;
    for (const double entry : archive_of(rate).values) {
        asked.rates.emplace_back();
        asked.rates.back()[0] = entry;
    }
    if (asked.rates.size() != asked.values.size())
        throw std::invalid_argument("the rate of a scene needs the structure of the scene");
    const auto on_side = [&](int side) {
        Answer answer = elastocheck_dual::compile(asked, everything, side);
        answer.scene = asked;
        return answer;
    };
    const Answer answer = on_side(0);
    require_same(plain, answer);
    return rate_in(plain, answer, 0, {"", {}}, on_side);
}

}  // namespace elastocheck
