// Whatever is done to what comes from outside, the answer is one that is documented. The corpus holds sound inputs, and
// every one that once had another answer, under the name of what it did; a search for more is ./dev fuzz.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include "tests/fuzz/mutation.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck::fuzz {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> corpus(const Target& target) {
    std::map<std::string, std::string> inputs;
    const auto take = [&](const fs::directory_entry& entry) {
        inputs[entry.path().filename().string()] = support::text_of(entry.path());
    };
    const fs::path own = fs::path(ELASTOCHECK_CORPUS) / target.name;
    if (fs::exists(own)) std::ranges::for_each(fs::directory_iterator(own), take);
    if (!target.samples.empty())
        for (const auto& entry : fs::recursive_directory_iterator(ELASTOCHECK_IMPORT))
            if (entry.path().has_extension() &&
                target.samples.find(entry.path().extension().string()) != target.samples.npos)
                take(entry);
    return inputs;
}

class Fuzz : public testing::TestWithParam<Target> {};

void run(const Target& target, std::string_view input, const std::string& of) {
    const auto begin = std::chrono::steady_clock::now();
    try {
        target.run(input);
    } catch (const std::exception& error) {
        ADD_FAILURE() << of << ": " << error.what() << "\n" << input.substr(0, 4000);
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(time.count(), 60)
        << of << ": hangs";  // far above what a busy machine makes of five seconds
}

TEST_P(Fuzz, EveryInputOfTheCorpusIsReadOrRefusedAsDocumented) {
    const auto inputs = corpus(GetParam());
    EXPECT_FALSE(inputs.empty());
    for (const auto& [name, input] : inputs) {
        EXPECT_LT(input.size(), 20'000u) << name << ": the corpus is kept small";
        run(GetParam(), input, name);
    }
}

TEST_P(Fuzz, MutatedInputIsReadOrRefusedAsDocumented) {
    Dice dice{20'130};
    std::set<std::string> different;
    const auto inputs = corpus(GetParam());
    const int each = 20 + 1000 / static_cast<int>(inputs.size());
    for (const auto& [name, input] : inputs)
        for (int k = 0; k < each && !HasFailure(); ++k) {
            std::string one = mutated(GetParam(), input, dice);
            if (k % 3 == 0) one = mutated(GetParam(), one, dice);
            run(GetParam(), one, name + ", mutation " + std::to_string(k));
            different.insert(std::move(one));
        }
    EXPECT_GT(different.size(), 400u);
    std::printf("%zu different inputs\n", different.size());
}

INSTANTIATE_TEST_SUITE_P(Inputs, Fuzz, testing::ValuesIn(targets),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace elastocheck::fuzz
