#pragma once
/// \file
/// A value or the reason why there is none (std::expected is C++23).

#include <cassert>
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

/// Either a value or a `Failure`. \pre of `value()`: `ok()`; of `failure()`: `!ok()` (both asserted).
template <class T> class [[nodiscard]] Result {
  public:
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {} // NOLINT(google-explicit-constructor)
    Result(Failure failure)
        : content_(std::in_place_index<1>, std::move(failure)) {} // NOLINT(google-explicit-constructor)
    [[nodiscard]] bool ok() const { return content_.index() == 0; }
    [[nodiscard]] T& value() {
        assert(ok());
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const T& value() const {
        assert(ok());
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const Failure& failure() const {
        assert(!ok());
        return *std::get_if<1>(&content_);
    }

  private:
    std::variant<T, Failure> content_;
};

} // namespace isostat
