#define BOOST_TEST_MODULE annulus
#include <boost/test/unit_test.hpp>
