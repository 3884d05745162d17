#pragma once
/// \file
/// The one exception type of the library: bad input and failed input or output. Domain failures (no equilibrium,
/// undecided tie, overlap) are values (`Result`), programming errors are assertions.

#include <isostat/core/machine.hpp>

#include <stdexcept>
#include <string>

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
        case ErrorKind::usage: return 64;
        case ErrorKind::bad_input: return 65;
        case ErrorKind::internal: return 70;
        case ErrorKind::cannot_write: return 74;
        }
        return 70;
    }

  private:
    ErrorKind kind_;
};

} // namespace isostat
