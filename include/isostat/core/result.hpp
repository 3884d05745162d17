#pragma once
/// \file
/// Why something was not done. Bad input and failed input or output are exceptions of one type (`Error`); outcomes of
/// the mechanics or of the arithmetic (no equilibrium, undecided tie, overlap) are values (`Result`; std::expected is
/// C++23); programming errors are assertions.

#include <isostat/core/contact.hpp>
#include <isostat/core/machine.hpp>

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace isostat {

/// Which exit status an error leads to (the values of sysexits.h). `internal`: this computer or this program has a
/// defect; the error says nothing about the input.
enum class ErrorKind { usage, bad_input, internal, cannot_write };

/// Bad input, or a file that cannot be read or written. `what()` is the complete message: file, line or field, the
/// value found and what was expected.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    [[nodiscard]] ErrorKind kind() const { return kind_; }
    /// 64, 65, 70 or 74.
    [[nodiscard]] int exit_status() const {
        switch (kind_) {
        case ErrorKind::usage: return 64;        // exact: sysexits.h, EX_USAGE
        case ErrorKind::bad_input: return 65;    // exact: sysexits.h, EX_DATAERR
        case ErrorKind::internal: return 70;     // 70: exact: sysexits.h, EX_SOFTWARE
        case ErrorKind::cannot_write: return 74; // exact: sysexits.h, EX_IOERR
        }
        return 70;
    }

  private:
    ErrorKind kind_;
};

/// Why a computation has no result. These are outcomes of the mechanics or of the arithmetic, not bad input.
enum class FailureKind {
    not_isostatic, ///< N != N_f, or the rank is smaller
    overlap,       ///< two grains overlap
    tie,           ///< two candidates could not be ordered: several contacts at once
    undecided,     ///< a sign could not be decided with the arithmetic allowed
    no_limit,      ///< the load can grow for ever: nothing opens
    flows,         ///< a dead shear force moves the tilt of a cell without end
    unbounded,     ///< a motion finds no new contact, or a linear programme is unbounded
    not_converged, ///< an iteration stopped short
    cap_reached,   ///< a cap on arcs or strain: the sample fails at this load
    contradiction, ///< what was proved in one way is refuted in another: a defect of the program
    interrupted    ///< stopped by the user
};

/// The word used in records and messages.
const char* to_string(FailureKind kind);

/// Words for a reader, put together on request, and the contacts and disks that they name.
class Words {
  public:
    Words() = default;                                      ///< no words
    Words(std::string fixed);                               // NOLINT(google-explicit-constructor)
    Words(const char* fixed) : Words(std::string(fixed)) {} // NOLINT(google-explicit-constructor)
    /// `make` is given the dimension; it must own all that it needs.
    explicit Words(std::function<std::string(int)> make) : make_(std::move(make)) {}

    std::vector<Contact> contacts; ///< in the order in which they are named
    std::vector<int> disks;        ///< disks that are named by themselves

    [[nodiscard]] bool empty() const { return make_ == nullptr; }
    /// `dimension`: of the grains, which the names of contacts depend on.
    [[nodiscard]] std::string text(int dimension = 2) const { return make_ ? make_(dimension) : std::string(); }
    /// Adds the contacts and disks that these words name.
    void name(const Words& others);
    /// Appends `more`.
    Words& operator+=(const Words& more);

  private:
    std::function<std::string(int)> make_;
};

/// The reason: words with the numbers that were measured, and the contacts or disks concerned.
struct Failure {
    FailureKind kind;
    Words words;

    [[nodiscard]] std::string message(int dimension = 2) const { return words.text(dimension); }
    [[nodiscard]] const std::vector<Contact>& contacts() const { return words.contacts; }
    [[nodiscard]] const std::vector<int>& disks() const { return words.disks; }
};

/// Where a failure happened: put before its message, so that the last line of a run says all.
Failure located(const Failure& failure, Words where);

/// Throws std::logic_error, with the reason why there is no value:
/// a `value()` was asked of a failure, or a `failure()` of a value.
[[noreturn]] void throw_no_value(const Failure& failure);
[[noreturn]] void throw_no_failure();

/// Either a value or a `Failure`. Asking for the alternative that is absent is a defect of the caller: in every build
/// this throws std::logic_error, with the message of the failure if there is one.
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
