#include "core/refuse.hpp"

#include <isostat/core/result.hpp>

#include <stdexcept>
#include <utility>

namespace isostat {

const char* to_string(FailureKind kind) {
    static constexpr auto words =
        words_of<FailureKind>("not isostatic", "overlap", "tie", "undecided", "no limit", "flows", "unbounded",
                              "not converged", "cap reached", "contradiction", "interrupted");
    return word_of(kind, words);
}

void refuse(const std::string& where, const std::string& what) {
    throw Error(ErrorKind::bad_input, where + ": " + what);
}

Words::Words(std::string fixed) {
    if (!fixed.empty()) {
        make_ = [fixed = std::move(fixed)](int) { return fixed; };
    }
}

void Words::name(const Words& others) {
    contacts.insert(contacts.end(), others.contacts.begin(), others.contacts.end());
    disks.insert(disks.end(), others.disks.begin(), others.disks.end());
}

Words& Words::operator+=(const Words& more) {
    if (!more.empty()) {
        make_ = [first = std::move(make_), second = more.make_](int dimension) {
            return (first ? first(dimension) : std::string()) + second(dimension);
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
