#pragma once
// An expression must throw isostat::Error of a kind, with a message that contains all of some words.

#include "support/test.hpp"

template <class Work> void expect_error(Work&& work, isostat::ErrorKind kind, const std::vector<std::string>& words) {
    try {
        work();
    } catch (const isostat::Error& error) {
        BOOST_TEST((error.kind() == kind), error.what());
        for (const std::string& word : words) {
            BOOST_TEST((std::string(error.what()).find(word) != std::string::npos),
                       "'" << word << "' is not in: " << error.what());
        }
        return;
    }
    std::string all;
    for (const std::string& word : words) {
        all += " '" + word + "'";
    }
    BOOST_ERROR("nothing was refused; expected a message with" + all);
}

template <class Work> void expect_bad_input(Work&& work, const std::vector<std::string>& words) {
    expect_error(work, isostat::ErrorKind::bad_input, words);
}
