// std::visit over a closed set of kinds, one lambda a kind.
#pragma once

namespace elastocheck::reference::energy {

template <class... F>
struct overloaded : F... {
    using F::operator()...;
};

}  // namespace elastocheck::reference::energy
