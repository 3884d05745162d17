#pragma once
/// \file
/// Words of failures that name contacts, put together when they are shown: private to the library.

#include <isostat/contact/contact.hpp>
#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <string>

namespace isostat {

/// A contact within words.
template <int Dim> struct Named {
    Contact contact;
};
template <int Dim> Named<Dim> named(const Contact& contact) {
    return {contact};
}

/// What words name is found among their arguments.
template <class Value> void collect_names(Words& /*words*/, const Value& /*value*/) {}
template <int Dim> void collect_names(Words& words, const Named<Dim>& name) {
    words.contacts.push_back(name.contact);
}
inline void collect_names(Words& words, const Words& inner) {
    words.name(inner);
}
inline void collect_names(Words& words, const Failure& inner) {
    words.name(inner.words);
}

/// As fmt::format. Contacts that are `named`, other words and failures among the arguments are what it names. The
/// arguments are copied; a character array must be a literal.
template <class... Values> Words words(fmt::format_string<const Values&...> format, Values... values) {
    Words made([text = fmt::string_view(format), values...]() -> std::string {
        return fmt::vformat(text, fmt::make_format_args(values...));
    });
    (collect_names(made, values), ...);
    return made;
}

template <class... Values>
Failure failed(FailureKind kind, fmt::format_string<const Values&...> format, Values... values) {
    return {kind, words<Values...>(format, std::move(values)...)};
}

} // namespace isostat

template <int Dim> struct fmt::formatter<isostat::Named<Dim>> : fmt::formatter<std::string> {
    template <class Context> auto format(const isostat::Named<Dim>& name, Context& context) const {
        return fmt::formatter<std::string>::format(isostat::to_string<Dim>(name.contact), context);
    }
};
template <> struct fmt::formatter<isostat::Words> : fmt::formatter<std::string> {
    template <class Context> auto format(const isostat::Words& words, Context& context) const {
        return fmt::formatter<std::string>::format(words.text(), context);
    }
};
template <> struct fmt::formatter<isostat::Failure> : fmt::formatter<std::string> {
    template <class Context> auto format(const isostat::Failure& failure, Context& context) const {
        return fmt::formatter<std::string>::format(failure.message(), context);
    }
};
