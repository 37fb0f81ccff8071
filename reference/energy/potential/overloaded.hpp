// std::visit over a closed set of kinds, one lambda per kind.
#pragma once

namespace elastocheck::reference::energy {

template <class... F>
struct overloaded : F... {
    using F::operator()...;
};
template <class... F>
overloaded(F...) -> overloaded<F...>;  // clang 14 does not deduce it

}  // namespace elastocheck::reference::energy
