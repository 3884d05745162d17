// Which disks touch? Three crafted disks in a box, their coordinates exact numbers: contacts are the pairs whose gap is
// exactly 0, and no pair overlaps. A radius that is larger by 1e-30 does. In doubles no gap need be 0: the contacts of
// a vertex are part of it, never found from a threshold.
#include <isostat/crafted/exact_packing.hpp>

#include <cstdio>

int main() {
    using namespace isostat;
    using exact::Number;
    const Number height = Number::parse("1/4*sqrt(33)"); // disk 2 rests on both others: sqrt((7/4)^2 - 1)
    crafted::ExactPacking packing;
    packing.walls = Walls::box(); // the paper's: left and bottom fixed, right and top movable
    packing.radius = {1, 1, Number::parse("3/4")};
    packing.centre = {{1, 1}, {3, 1}, {2, 1 + height}};
    packing.length = {4, Number::parse("7/4") + height};

    const Result<std::vector<Contact>> contacts = crafted::exact_contacts(packing);
    if (!contacts.ok()) {
        std::printf("%s\n", contacts.failure().message().c_str());
        return 1;
    }
    const Packing nearest = crafted::approximate(packing);
    for (const Contact& contact : contacts.value()) {
        std::printf("%-10s gap 0; %9.2e of the nearest doubles\n", to_string(contact).c_str(), gap(nearest, contact));
    }
    packing.radius[2] += Number::parse("1e-30");
    const Result<std::vector<Contact>> larger = crafted::exact_contacts(packing);
    std::printf("larger by 1e-30: %s\n", larger.ok() ? "no overlap" : larger.failure().message().c_str());
    return contacts.value().size() == 8 && !larger.ok() ? 0 : 1;
}
