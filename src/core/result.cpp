#include <isostat/core/result.hpp>

#include <stdexcept>
#include <utility>

namespace isostat {

const char* to_string(FailureKind kind) {
    switch (kind) {
    case FailureKind::not_isostatic: return "not isostatic";
    case FailureKind::overlap: return "overlap";
    case FailureKind::tie: return "tie";
    case FailureKind::undecided: return "undecided";
    case FailureKind::no_limit: return "no limit";
    case FailureKind::flows: return "flows";
    case FailureKind::unbounded: return "unbounded";
    case FailureKind::not_converged: return "not converged";
    case FailureKind::cap_reached: return "cap reached";
    case FailureKind::contradiction: return "contradiction";
    case FailureKind::interrupted: return "interrupted";
    }
    return "failure";
}

Words::Words(std::string fixed) {
    if (!fixed.empty()) {
        make_ = [fixed = std::move(fixed)] { return fixed; };
    }
}

void Words::name(const Words& others) {
    contacts.insert(contacts.end(), others.contacts.begin(), others.contacts.end());
    disks.insert(disks.end(), others.disks.begin(), others.disks.end());
}

Words& Words::operator+=(const Words& more) {
    if (!more.empty()) {
        make_ = [first = std::move(make_), second = more.make_] {
            return (first ? first() : std::string()) + second();
        };
    }
    name(more);
    return *this;
}

Failure located(const Failure& failure, Words where) {
    where += ": ";
    where += failure.words;
    return {failure.kind, std::move(where)};
}

void throw_no_value(const Failure& failure) {
    throw std::logic_error(std::string("the value of a result was asked for, which failed: ") +
                           to_string(failure.kind) + ": " + failure.message());
}

void throw_no_failure() {
    throw std::logic_error("the failure of a result was asked for, which has a value");
}

} // namespace isostat
