// The checker is worth something because it shares no code with what it checks: only data and readers.
#include "support/scratch.hpp"

namespace {

const std::vector<std::string> allowed{"\"checker/",
                                       "\"io/json.hpp\"",
                                       "\"io/numbers.hpp\"", // reads the text of a number
                                       "\"io/record_digests.hpp\"",
                                       "\"io/equilibria.hpp\"", // the names of columns
                                       "\"io/folders.hpp\"",    // and of files
                                       "<isostat/checker/",
                                       "<isostat/core/",
                                       "<isostat/packing/packing.hpp>",
                                       "<isostat/packing/load.hpp>",
                                       "<isostat/contact/state.hpp>",
                                       "<isostat/io/state_file.hpp>",
                                       "<isostat/io/state_file.hpp>",
                                       "\"io/files.hpp\"",
                                       "\"core/parallel.hpp\"",
                                       "<Eigen/",
                                       "<fmt/",
                                       "<gmpxx.h>",
                                       "<klu.h>"}; // not trusted: exact residuals follow

/// <vector>, <cmath>: headers of the standard have neither a folder nor an ending.
bool of_the_standard(const std::string& header) {
    return header.starts_with('<') && header.find_first_of("/.") == std::string::npos;
}

} // namespace

BOOST_AUTO_TEST_CASE(the_checker_includes_nothing_of_what_it_checks) {
    int files = 0, headers = 0;
    for (const char* folder : {"/../src/checker", "/../include/isostat/checker"}) {
        for (const auto& entry : std::filesystem::directory_iterator(std::string(ISOSTAT_EXAMPLES) + folder)) {
            ++files;
            for (const std::string& line : scratch::lines_of(entry.path())) {
                if (!line.starts_with("#include ")) {
                    continue;
                }
                ++headers;
                const std::string header = line.substr(9);
                const bool known = std::ranges::any_of(
                    allowed, [&header](const std::string& start) { return header.starts_with(start); });
                BOOST_TEST((known || of_the_standard(header)), entry.path().filename().string() << ": " << line);
            }
        }
    }
    BOOST_TEST(files > 20);
    BOOST_TEST(headers > 50);
}
