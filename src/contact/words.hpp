#pragma once
/// \file
/// Words of failures that name contacts, put together when they are shown, and lists of names: private to the library.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// A contact as an argument of words.
struct Named {
    Contact contact;
};
inline Named named(const Contact& contact) {
    return {contact};
}

/// Collects the contacts that words name from their arguments.
template <class Value> void collect_names(Words& /*words*/, const Value& /*value*/) {}
inline void collect_names(Words& words, const Named& name) {
    words.contacts.push_back(name.contact);
}
inline void collect_names(Words& words, const Words& inner) {
    words.name(inner);
}
inline void collect_names(Words& words, const Failure& inner) {
    words.name(inner.words);
}

/// The text of an argument.
template <class Value> const Value& in_text(const Value& value, int /*dimension*/ = 2) {
    return value;
}
inline std::string in_text(const Named& name, int dimension = 2) {
    return to_string(name.contact, dimension);
}
inline std::string in_text(const Words& words, int dimension = 2) {
    return words.text(dimension);
}
inline std::string in_text(const Failure& failure, int dimension = 2) {
    return failure.message(dimension);
}

template <class... Values>
using FormatOfWords = fmt::format_string<decltype(in_text(std::declval<const std::type_identity_t<Values>&>()))...>;

/// Formats as fmt::format does. The words name contacts that are `named`, and what other words and failures among the
/// arguments name. The arguments are copied; a character array must be a literal.
template <class... Values> Words words(FormatOfWords<Values...> format, Values... values) {
    Words made([text = fmt::string_view(format), values...]([[maybe_unused]] int dimension) -> std::string {
        return fmt::format(fmt::runtime(text), in_text(values, dimension)...);
    });
    (collect_names(made, values), ...);
    return made;
}

template <class... Values> Failure failed(FailureKind kind, FormatOfWords<Values...> format, Values... values) {
    return {kind, words<Values...>(format, std::move(values)...)};
}

/// "12-40", "3-left", ...
inline std::vector<std::string> contact_names(const std::vector<Contact>& contacts, int dimension) {
    std::vector<std::string> names;
    for (const Contact& contact : contacts) {
        names.push_back(to_string(contact, dimension));
    }
    return names;
}

/// Names of the N_f degrees of freedom, in their order: "x of disk 3", "top wall", ...
inline std::vector<std::string> dof_names(const Packing& packing) {
    const DofMap dofs(packing);
    std::vector<std::string> names;
    for (int d = 0; d < dofs.dof_count(); ++d) {
        names.push_back(dofs.name(d));
    }
    return names;
}

} // namespace isostat
