// Formatting of numbers for readers.
#include "reports/text/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace elastocheck::reports {
namespace {

TEST(Numbers, HaveThreeToFourDigitsAndATrueMinus) {
    EXPECT_EQ(number(2.9137), "2.91");
    EXPECT_EQ(number(-0.0018049, 2), "−0.0018");
    EXPECT_EQ(number(1091.4334, 4), "1091");
    EXPECT_EQ(number(123456.0), "123456");
    EXPECT_EQ(number(0), "0");
    EXPECT_EQ(number(0.99996, 3), "1.00");
    EXPECT_EQ(number(2.6e-13, 2), "2.6\u00a0×\u00a010⁻¹³");
    EXPECT_EQ(number(-3.456e7), "−3.46\u00a0×\u00a010⁷");
    EXPECT_EQ(signed_number(0.5), "+0.500");
}

TEST(Numbers, NonFiniteNumberIsADash) {
    EXPECT_EQ(number(NAN), "–");
    EXPECT_EQ(number(-std::numeric_limits<double>::infinity()), "–");
    EXPECT_EQ(percent(NAN), "–");
    EXPECT_EQ(deviation_number(NAN), "–");
    EXPECT_EQ(signed_number(std::numeric_limits<double>::infinity()), "–");
}

TEST(Numbers, PercentagesAreRoundedAndCountsAreGroupedInThousands) {
    EXPECT_EQ(percent(0.0293), "2.9\u00a0%");
    EXPECT_EQ(percent(-0.5), "−50\u00a0%");
    EXPECT_EQ(percent(2.34), "234\u00a0%");
    EXPECT_EQ(percent(1e-9), "< 0.001\u00a0%");
    EXPECT_EQ(percent(21521251.35), "> 1000\u00a0%");
    EXPECT_EQ(percent(0), "0\u00a0%");
    EXPECT_EQ(whole_number(999), "999");
    EXPECT_EQ(whole_number(104313), "104\u202f313");
    EXPECT_EQ(whole_number(-1000000), "−1\u202f000\u202f000");
    EXPECT_EQ(setting(0.01, "mm"), "0.01\u00a0mm");
    EXPECT_EQ(deviation_number(3e-10), "0");
}

}  // namespace
}  // namespace elastocheck::reports
