#include "convert.hpp"
#include "io/equilibria.hpp"
#include "io/text.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>

#include <unistd.h>

#include <cmath>
#include <functional>
#include <map>

namespace isostat::python {

void bind_run(py::module_& module);      // run.cpp
void bind_ensemble(py::module_& module); // ensemble.cpp

namespace {

/// An attribute of a Python module of this package.
py::object ours(const char* file, const char* name) {
    return py::module_::import(file).attr(name);
}

/// From the number of a wall in pairs (i, j) to its name, the highest number first.
py::dict wall_names() {
    std::map<int, const char*, std::greater<>> names;
    for (const WallFacts& facts : wall_facts) {
        for (std::size_t a = 0; a < most_axes; ++a) {
            names.emplace(facts.column[a], facts.name[a]);
        }
    }
    return py::cast(names);
}

} // namespace

py::array_t<int> contact_array(const std::vector<Contact>& contacts) {
    py::array_t<int> array({static_cast<py::ssize_t>(contacts.size()), py::ssize_t{2}});
    auto rows = array.mutable_unchecked<2>();
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const auto row = static_cast<py::ssize_t>(l);
        std::tie(rows(row, 0), rows(row, 1)) = contact_columns(contacts[l]);
    }
    return array;
}

py::object contact_pair(const Contact& contact) {
    return contact.i < 0 ? py::object(py::none()) : py::cast(contact_columns(contact));
}

double finite(double value, const char* name) {
    if (!std::isfinite(value)) {
        throw Error(ErrorKind::bad_input,
                    std::string(name) + " is " + std::to_string(value) + ": expected a finite number");
    }
    return value;
}

py::array_t<double> interval_array(const std::vector<Interval>& intervals) {
    py::array_t<double> array({static_cast<py::ssize_t>(intervals.size()), py::ssize_t{2}});
    auto rows = array.mutable_unchecked<2>();
    for (std::size_t l = 0; l < intervals.size(); ++l) {
        rows(static_cast<py::ssize_t>(l), 0) = intervals[l].lower;
        rows(static_cast<py::ssize_t>(l), 1) = intervals[l].upper;
    }
    return array;
}

py::object verdict_object(Verdict verdict) {
    return ours("isostat._words", "Verdict")(std::string(to_string(verdict)));
}

void raise(const Failure& failure, int dimension) {
    const py::object type = ours("isostat._words", "failure_of")(to_string(failure.kind));
    PyErr_SetObject(type.ptr(), py::str(text::shown(failure.message(dimension))).ptr());
    throw py::error_already_set();
}

void check_signals() {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
    }
}

namespace {

std::vector<std::function<bool()>>& left_behind() {
    static auto* const list = new std::vector<std::function<bool()>>; // lives longer than every destructor
    return *list;
}

} // namespace

void leave_behind(std::thread thread, std::function<bool()> ended) {
    static const bool registered [[maybe_unused]] = [] {
        // The process ends with its own status before static objects that a thread still uses are destroyed.
        const auto leave = [](int status, void*) {
            for (const auto& has_ended : left_behind()) {
                if (!has_ended()) {
                    _exit(status);
                }
            }
        };
        return ::on_exit(leave, nullptr) == 0;
    }();
    thread.detach();
    left_behind().push_back(std::move(ended));
}

/// Translates each `Error` of the library to isostat.BadInput and so on.
void bind_errors(py::module_& /*module*/) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            std::rethrow_exception(std::move(thrown));
        } catch (const Error& error) {
            const py::object type = ours("isostat._words", "error_of")(error.exit_status());
            PyErr_SetString(type.ptr(), text::shown(error.what()).c_str());
        }
    });
}

} // namespace isostat::python

PYBIND11_MODULE(_core, module) {
    using namespace isostat::python;
    module.doc() = "Compiled part of isostat.";
    module.attr("version") = ISOSTAT_VERSION;
    module.attr("_integer_columns") = pybind11::frozenset(pybind11::cast(isostat::integer_columns()));
    module.attr("_walls") = wall_names();
    module.def(
        "set_threads",
        [](int count) {
            if (count < 1) {
                throw isostat::Error(isostat::ErrorKind::bad_input,
                                     "count is " + std::to_string(count) + ": expected at least 1");
            }
            isostat::set_threads(count);
        },
        py::arg("count"), "Threads of this process: they change times and never a bit of a result.");
    module.def("available_cores", &isostat::available_cores, "Cores that this process may use.");
    bind_errors(module);
    bind_state(module);
    bind_proofs(module);
    bind_exact(module);
    bind_preparation(module);
    bind_compare(module);
    bind_run(module);
    bind_ensemble(module);
}
