// One function a kind for std::visit: a kind that is forgotten does not compile.
#pragma once

namespace elastocheck::compare {

template <class... F>
struct overloaded : F... {
    using F::operator()...;
};
template <class... F>
overloaded(F...) -> overloaded<F...>;  // clang 14 does not deduce it

}  // namespace elastocheck::compare
