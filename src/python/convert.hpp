#pragma once
/// \file
/// Used by all parts of the bindings: arrays that view memory of the library, contacts as pairs of integers, verdicts
/// as the Python enumeration, failures as exceptions.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace isostat::python {

namespace py = pybind11;

/// A state in Python: the state and the forces that its file may have.
using PyState = StateFile;

/// A type as Python writes it.
template <std::size_t N> struct TypeName {
    char text[N]{}; // NOLINT(*-avoid-c-arrays): pybind11 takes one
    constexpr TypeName(const char (&name)[N]) { std::copy_n(name, N, text); } // NOLINT(*-c-arrays,*-explicit-*)
};
/// An object of Python whose type is in the signature, and so in the stub (stub.py).
template <TypeName type, class Object = py::object> struct As : Object {
    As(Object object) : Object(std::move(object)) {} // NOLINT(google-explicit-constructor)
    using Object::Object;
    static bool check_(py::handle) { return true; } // NOLINT(readability-identifier-naming): a name of pybind11
};

/// Read-only array that views `data`; `owner` lives as long as the array.
template <class T> py::array_t<T> view(const T* data, std::vector<py::ssize_t> shape, py::handle owner) {
    py::array_t<T> array(std::move(shape), data, owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}
template <class T> py::array_t<T> view(const std::vector<T>& data, py::handle owner) {
    return view(data.data(), {static_cast<py::ssize_t>(data.size())}, owner);
}

/// A property that is a view of a vector of the object.
template <class Class, class T> auto vector_of(std::vector<T> Class::*member) {
    return [member](const py::object& self) { return view(self.cast<const Class&>().*member, self); };
}

/// (N, 2) integers: as in equilibria.csv, j = -1 left, -2 bottom, -3 right, -4 top wall, of spheres -5 back, -6 front,
/// -9 held coordinate i.
py::array_t<int> contact_array(const std::vector<Contact>& contacts);
/// The pair of one contact; None for no contact (i = -1).
py::object contact_pair(const Contact& contact);
/// Returns the number. Throws `Error(bad_input)` when it is not finite.
double finite(double value, const char* name);
/// The ends of intervals, (n, 2).
py::array_t<double> interval_array(const std::vector<Interval>& intervals);

/// The member of isostat.Verdict.
py::object verdict_object(Verdict verdict);

/// Throws the exception of isostat that belongs to a failure of a packing of that dimension. \pre the interpreter is
/// locked
[[noreturn]] void raise(const Failure& failure, int dimension);

/// The value, or the exception.
template <class T> T value_or_raise(Result<T>&& result, int dimension) {
    if (!result.ok()) {
        raise(result.failure(), dimension);
    }
    return std::move(result.value());
}

/// Runs `work` with the interpreter unlocked.
template <class Work> auto unlocked(Work work) {
    const py::gil_scoped_release release;
    return work();
}

/// Throws KeyboardInterrupt when Ctrl-C was pressed (main thread). Locks the interpreter.
void check_signals();

/// Keeps a computation that Ctrl-C abandoned: it ends by itself, or with the process. `ended` says whether it has.
void leave_behind(std::thread thread, std::function<bool()> ended);

/// Runs `work` on another thread with the interpreter unlocked; at Ctrl-C throws KeyboardInterrupt and abandons the
/// work. For computations that nothing can stop. \pre `work` owns what it uses and touches nothing of Python.
template <class Work> auto interruptible(Work work) {
    using Value = std::invoke_result_t<Work>;
    constexpr std::chrono::milliseconds pause{50};
    std::packaged_task<Value()> task(std::move(work));
    const auto value = std::make_shared<std::future<Value>>(task.get_future());
    const auto ended = [value](std::chrono::milliseconds wait) {
        return value->wait_for(wait) == std::future_status::ready;
    };
    std::thread thread(std::move(task));
    try {
        const py::gil_scoped_release release;
        while (!ended(pause)) {
            check_signals();
        }
    } catch (...) {
        leave_behind(std::move(thread), [ended] { return ended(std::chrono::milliseconds{0}); });
        throw;
    }
    thread.join();
    return value->get();
}

void bind_errors(py::module_& module);
void bind_state(py::module_& module);
void bind_proofs(py::module_& module);
void bind_exact(py::module_& module);
void bind_preparation(py::module_& module);
void bind_compare(py::module_& module);

} // namespace isostat::python

namespace pybind11::detail {
template <isostat::python::TypeName type, class Object> struct handle_type_name<isostat::python::As<type, Object>> {
    static constexpr auto name = const_name(type.text);
};
/// Verdicts become members of isostat.Verdict, which do not convert to bool.
template <> struct type_caster<isostat::Verdict> {
    PYBIND11_TYPE_CASTER(isostat::Verdict, const_name("isostat.Verdict"));
    bool load(handle, bool) { return false; } // Python never passes a verdict
    static handle cast(isostat::Verdict verdict, return_value_policy, handle) {
        return isostat::python::verdict_object(verdict).release();
    }
};
/// An enclosure is a pair (value, radius).
template <> struct type_caster<isostat::Enclosure> {
    PYBIND11_TYPE_CASTER(isostat::Enclosure, const_name("Tuple[float, float]"));
    bool load(handle, bool) { return false; }
    static handle cast(const isostat::Enclosure& e, return_value_policy, handle) {
        return make_tuple(e.value, e.radius).release();
    }
};
/// The arithmetic is its word.
template <> struct type_caster<isostat::Rung> {
    PYBIND11_TYPE_CASTER(isostat::Rung, const_name("str"));
    bool load(handle, bool) { return false; }
    static handle cast(isostat::Rung rung, return_value_policy, handle) {
        return str(std::string(isostat::to_string(rung))).release();
    }
};
/// An interval is a pair (lower, upper).
template <> struct type_caster<isostat::Interval> {
    PYBIND11_TYPE_CASTER(isostat::Interval, const_name("Tuple[float, float]"));
    bool load(handle, bool) { return false; }
    static handle cast(const isostat::Interval& interval, return_value_policy, handle) {
        return make_tuple(interval.lower, interval.upper).release();
    }
};
/// A contact is a pair of integers, or None.
template <> struct type_caster<isostat::Contact> {
    PYBIND11_TYPE_CASTER(isostat::Contact, const_name("Optional[Tuple[int, int]]"));
    bool load(handle, bool) { return false; }
    static handle cast(const isostat::Contact& contact, return_value_policy, handle) {
        return isostat::python::contact_pair(contact).release();
    }
};
} // namespace pybind11::detail
