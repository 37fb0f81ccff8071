#include "reports/python/convert.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace elastocheck::python {

namespace py = pybind11;

reports::Settings settings_of(const py::dict& values) {
    reports::Settings settings;
    for (const auto& [key, value] : values) {
        if (!py::isinstance<py::str>(key))
            throw py::type_error("a setting's name is a text: \"springs.coil.rate\"");
        const auto path = key.cast<std::string>();
        if (py::isinstance<py::str>(value)) {
            settings.push_back({path, value.cast<std::string>()});
            continue;
        }
        const bool is_number = PyFloat_Check(value.ptr()) || PyIndex_Check(value.ptr()) ||
                               py::hasattr(value, "__float__");
        if (!is_number || PyBool_Check(value.ptr()))
            throw py::type_error(fmt::format("{}: {}; allowed: a number or a text", path,
                                             py::repr(value).cast<std::string>()));
        settings.push_back(setting(path, py::float_(py::reinterpret_borrow<py::object>(value))));
    }
    return settings;
}

namespace {

py::array owned(std::vector<double> values, std::vector<py::ssize_t> shape) {
    auto kept = std::make_unique<std::vector<double>>(std::move(values));
    const double* data = kept->data();
    const py::capsule owner(kept.release(),
                            [](void* all) { delete static_cast<std::vector<double>*>(all); });
    return py::array_t<double>(std::move(shape), data, owner);
}

}  // namespace

py::array matrix(std::vector<double> values, std::size_t columns) {
    const auto rows = static_cast<py::ssize_t>(columns == 0 ? 0 : values.size() / columns);
    return owned(std::move(values), {rows, static_cast<py::ssize_t>(columns)});
}

py::array poses(std::vector<double> values, std::size_t bodies) {
    const auto points = static_cast<py::ssize_t>(bodies == 0 ? 0 : values.size() / (7 * bodies));
    return owned(std::move(values), {points, static_cast<py::ssize_t>(bodies), 7});
}

compare::Progress progress_to(const py::object& function) {
    if (function.is_none()) return {};
    return [callee = function.ptr()](std::string_view what, double done) {
        const py::gil_scoped_acquire lock;
        const py::handle call = callee;
        call(py::str(what.data(), what.size()), done);
    };
}

}  // namespace elastocheck::python
