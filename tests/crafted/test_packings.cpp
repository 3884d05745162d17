// Every file of examples/packings is read, inspected and held against the answers it carries.

#include "examples.hpp"

BOOST_AUTO_TEST_CASE(every_example_packing_has_the_answers_it_carries) {
    using namespace isostat::crafted;
    std::vector<std::string> paths = examples::packing_files();
    BOOST_TEST(paths.size() >= 25u);
    const std::vector<std::string> spheres = examples::packing_files(true);
    BOOST_TEST(spheres.size() >= 8u);
    const std::vector<std::string> clumps = examples::packing_files(false, true);
    paths.insert(paths.end(), spheres.begin(), spheres.end());
    paths.insert(paths.end(), clumps.begin(), clumps.end());
    for (const std::string& path : paths) {
        BOOST_TEST_INFO_SCOPE(path);
        const PackingFile file = read_packing(path);
        BOOST_TEST(file.expected.size() >= 3u);
        const auto inspection = required(inspect(file.packing));
        for (const std::string& message : check_expected(inspection, file, path)) {
            BOOST_ERROR(message);
        }
        BOOST_TEST(!to_text(inspection, file.packing).empty());
    }
}
