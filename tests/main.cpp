// One main for the tests of every room, each the suite of its program; the cases are in test_*.cpp beside it.
#include <boost/test/unit_test.hpp>

#include <filesystem>

int main(int argc, char* argv[]) {
    const auto begin = [] {
        auto& suite = boost::unit_test::framework::master_test_suite();
        suite.p_name.value = std::filesystem::path(suite.argv[0]).filename().string(); // test_ROOM
        return true;
    };
    return boost::unit_test::unit_test_main(begin, argc, argv);
}
