#pragma once
/// \file
/// A value or the reason why there is none (std::expected is C++23).

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace isostat {

/// Why a computation has no result. These are outcomes of the mechanics or of the arithmetic, not bad input.
enum class FailureKind {
    not_isostatic, ///< N != N_f, or the rank is smaller
    overlap,       ///< two grains overlap
    tie,           ///< two candidates could not be ordered: several contacts at once
    undecided,     ///< a sign could not be decided with the arithmetic allowed
    no_limit,      ///< the load can grow for ever: nothing opens
    unbounded,     ///< a motion finds no new contact, or a linear programme is unbounded
    not_converged, ///< an iteration stopped short
    cap_reached,   ///< a cap on arcs or strain: the sample fails at this load
    contradiction, ///< what was proved in one way is refuted in another: a defect of the program
    interrupted    ///< stopped by the user
};

/// The word used in records and messages.
const char* to_string(FailureKind kind);

/// The reason, with the numbers that were measured and the contacts or disks concerned in `message`.
struct Failure {
    FailureKind kind;
    std::string message;
};

/// A `value()` was asked of a failure, or a `failure()` of a value: throws std::logic_error, which says why there is no
/// value.
[[noreturn]] void throw_no_value(const Failure& failure);
[[noreturn]] void throw_no_failure();

/// Either a value or a `Failure`. To ask for the one that is not there is a defect of the caller: in every build it
/// throws std::logic_error, with the message of the failure if there is one.
template <class T> class [[nodiscard]] Result {
  public:
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {} // NOLINT(google-explicit-constructor)
    Result(Failure failure)
        : content_(std::in_place_index<1>, std::move(failure)) {} // NOLINT(google-explicit-constructor)
    [[nodiscard]] bool ok() const { return content_.index() == 0; }
    [[nodiscard]] T& value() {
        require_value();
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const T& value() const {
        require_value();
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const Failure& failure() const {
        if (ok()) {
            throw_no_failure();
        }
        return *std::get_if<1>(&content_);
    }

  private:
    void require_value() const {
        if (!ok()) {
            throw_no_value(failure());
        }
    }
    std::variant<T, Failure> content_;
};

} // namespace isostat
