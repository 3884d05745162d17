// One main for the tests of every room; the suites are in test_*.cpp beside it.
#include <boost/test/unit_test.hpp>

int main(int argc, char* argv[]) {
    const auto begin = [] {
        boost::unit_test::framework::master_test_suite().p_name.value = "isostat";
        return true;
    };
    return boost::unit_test::unit_test_main(begin, argc, argv);
}
