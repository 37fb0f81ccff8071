#include "compare/variants/openturns.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace elastocheck::compare::variants::openturns {
namespace {

struct Module {
    const Functions* functions = nullptr;
    std::string trouble;
};

// Never closed: its functions are used until the program ends.
const Module& module() {
    static const Module loaded = [] {
        Module result;
        void* const handle = ::dlopen(module_file, RTLD_NOW | RTLD_LOCAL);
        void* const symbol = handle != nullptr ? ::dlsym(handle, module_symbol) : nullptr;
        if (symbol == nullptr)
            result.trouble = ::dlerror();
        else
            result.functions = reinterpret_cast<const Functions* (*)()>(symbol)();
        return result;
    }();
    return loaded;
}

const Functions& functions() {
    if (module().functions == nullptr)
        throw std::invalid_argument(fmt::format(
            "a study needs OpenTURNS, an optional component ({}); install the package "
            "elastocheck-study, or libopenturns-dev and build again, as ./dev study does",
            module().trouble));
    return *module().functions;
}

}  // namespace

bool available() { return module().functions != nullptr; }

Transformation transformation(const std::vector<Distribution>& distributions,
                              const Eigen::MatrixXd& correlation) {
    return functions().transformation(distributions, correlation);
}
std::vector<std::vector<std::uint64_t>> sobol_directions(std::size_t dimension, int bits) {
    return functions().sobol_directions(dimension, bits);
}
Eigen::MatrixXd latin_hypercube(std::uint64_t count, std::size_t dimension, std::uint64_t seed) {
    return functions().latin_hypercube(count, dimension, seed);
}
std::pair<double, double> clopper_pearson(std::uint64_t hits, std::uint64_t all, double level) {
    return functions().clopper_pearson(hits, all, level);
}
std::pair<std::int64_t, std::int64_t> percentile_ranks(std::uint64_t all, double share,
                                                       double level) {
    return functions().percentile_ranks(all, share, level);
}
SobolIndices sobol_indices(const Eigen::MatrixXd& outputs, double level, std::uint64_t seed) {
    return functions().sobol_indices(outputs, level, seed);
}

Rare rare(const Values& values, std::size_t dimension, const Threshold& threshold, double level,
          std::uint64_t seed, std::uint64_t most, std::uint64_t block) {
    return functions().rare(values, dimension, threshold, level, seed, most, block);
}

}  // namespace elastocheck::compare::variants::openturns
