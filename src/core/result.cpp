#include <isostat/core/result.hpp>

#include <stdexcept>

namespace isostat {

const char* to_string(FailureKind kind) {
    switch (kind) {
    case FailureKind::not_isostatic: return "not isostatic";
    case FailureKind::overlap: return "overlap";
    case FailureKind::tie: return "tie";
    case FailureKind::undecided: return "undecided";
    case FailureKind::no_limit: return "no limit";
    case FailureKind::unbounded: return "unbounded";
    case FailureKind::not_converged: return "not converged";
    case FailureKind::cap_reached: return "cap reached";
    case FailureKind::contradiction: return "contradiction";
    case FailureKind::interrupted: return "interrupted";
    }
    return "failure";
}

void throw_no_value(const Failure& failure) {
    throw std::logic_error(std::string("the value of a result was asked for, which failed: ") +
                           to_string(failure.kind) + ": " + failure.message);
}

void throw_no_failure() {
    throw std::logic_error("the failure of a result was asked for, which has a value");
}

} // namespace isostat
