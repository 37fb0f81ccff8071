// One target for libFuzzer: the name of the program says which, fuzz_scene.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "tests/fuzz/mutation.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace elastocheck::fuzz;

const Target* target = nullptr;

std::string_view text(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char*** argv) {
    const std::string program = std::filesystem::path((*argv)[0]).filename().string();
    for (const Target& one : targets)
        if (program == std::string("fuzz_") + one.name) target = &one;
    return target == nullptr;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    target->run(text(data, size));
    return 0;
}

// Half of the inputs as libFuzzer makes them, with the dictionary and what it saw compared; half by the format.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
    Dice dice{seed};
    if (dice.below(2) == 0) return LLVMFuzzerMutate(data, size, most);
    const std::string made = mutated(*target, text(data, size), dice);
    const std::size_t kept = std::min(made.size(), most);
    std::memcpy(data, made.data(), kept);
    return kept;
}
