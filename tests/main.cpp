// One main for the tests of every room; the suites are in test_*.cpp beside it.
#define BOOST_TEST_MODULE isostat
#include <boost/test/unit_test.hpp>
