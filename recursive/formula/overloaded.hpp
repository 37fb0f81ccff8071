// Visitor of a std::variant built from one lambda per kind; a missing kind does not compile.
#pragma once

namespace elastocheck::recursive {

template <class... F>
struct overloaded : F... {
    using F::operator()...;
};
template <class... F>
overloaded(F...) -> overloaded<F...>;  // clang 14 does not deduce this guide

}  // namespace elastocheck::recursive
