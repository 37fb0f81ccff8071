// The reader and compile() with dual numbers; part of the second compilation (dual.hpp).
#include "models/rates/dual.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>

#include "elastocheck/compile.hpp"
#include "models/rates/fields.hpp"
#include "models/reader/plausibility.hpp"
#include "models/real.hpp"

namespace elastocheck {

namespace {

bool changes(std::size_t direction, const Number& number) {
    return std::ranges::find(pass.changes[direction], number.path) != pass.changes[direction].end();
}

}  // namespace

Dual as_read(const Number& number) {
    Dual result = number.value;
    for (std::size_t k = 0; k < pass.changes.size(); ++k)
        if (changes(k, number)) result.dx[k] = 1;
    return result;
}

void as_counted(const Number& number) {
    for (std::size_t k = 0; k < pass.changes.size(); ++k)
        if (changes(k, number)) pass.whole_number[k] = true;
}

namespace {

struct Read {
    static constexpr bool writes = true;
    const Archive& from;
    std::size_t texts = 0, wholes = 0, numbers = 0;
    void text(std::string& x) { x = from.texts.at(texts++); }
    template <class T>
    void whole(T& x) {
        x = static_cast<T>(from.wholes.at(wholes++));
    }
    void number(Dual& x) {
        x = from.values.at(numbers);
        if (!from.rates.empty()) x.dx = from.rates.at(numbers);
        ++numbers;
    }
};

Detail detail_if(bool everything) { return everything ? Detail::everything : Detail::required; }

// The answer of f in a pass of its own.
template <class F>
Answer in_a_pass(Pass own, F f) {
    pass = std::move(own);
    Answer answer;
    try {
        f(answer);
    } catch (const std::exception& error) {
        answer = {};
        answer.error = error.what();
    }
    answer.tie = pass.tie;
    answer.whole_number = pass.whole_number;
    pass = {};
    return answer;
}

}  // namespace

Answer read(const File& file, bool everything, const std::vector<Together>& changes, int side) {
    std::vector<Setting> settings;
    for (const auto& [path, value] : file.settings) settings.push_back({path, value});
    const auto folder = file.folder ? reader::Folder(*file.folder) : std::nullopt;
    return in_a_pass(
        {.changes = changes, .count = changes.size(), .side = side}, [&](Answer& answer) {
            const Scene scene = reader::read_whole(file.text, file.name, settings, folder).scene;
            answer.scene = rates::archive_of(scene);
            answer.model = rates::archive_of(compile(scene, detail_if(everything)));
        });
}

Answer compile(const Archive& archive, bool everything, int side) {
    return in_a_pass({.changes = {}, .count = 1, .side = side}, [&](Answer& answer) {
        Scene scene;
        Read read{archive};
        rates::each_datum(read, scene);
        answer.model = rates::archive_of(compile(scene, detail_if(everything)));
    });
}

}  // namespace elastocheck
