// `verify --coq` without Coq: what is proved with it is for proofs/coq/check_equilibria.sh.
#include "cli/program.hpp"
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;

namespace {

/// A certificate of the state, and what `verify --coq` says of it where Python is there and Coq is not.
struct WithoutCoq {
    scratch::Folder folder;
    std::string path;

    WithoutCoq() {
        std::filesystem::create_directory(folder / "bin");
        std::filesystem::create_symlink("/usr/bin/python3", folder / "bin/python3");
        path = "PATH=" + quoted(folder.at("bin")) + " ";
    }
    [[nodiscard]] std::string certificate(const isostat::State& state, const std::string& name) const {
        isostat::write_state(folder.at("state.json"), state);
        run({"certify", folder.at("state.json"), "-o", folder.at(name)});
        return folder.at(name);
    }
    [[nodiscard]] Outcome verify(const std::vector<std::string>& files, const std::string& checker = "--coq") const {
        return run(plus({"verify", checker}, files), path);
    }
};

/// The line of Coq, undecided for this reason; where no example program was built (sanitizers) there is none to write
/// for Coq, and that is the reason.
std::string undecided_because(const std::string& reason, const std::string& line = "coq            ") {
    const std::filesystem::path writer = "examples/example_equilibrium_certificate";
    const bool built = std::filesystem::exists(std::filesystem::path(ISOSTAT_PROGRAM).parent_path() / writer);
    return line + "undecided " + (built ? reason : "not asked: ");
}

} // namespace

BOOST_AUTO_TEST_CASE(without_coq_nothing_is_said_to_be_proved_by_it) {
    const WithoutCoq here;
    const std::string file = here.certificate(crafted::two_disks(1, 2, 1, 1), "two.json");
    const std::string missing = undecided_because("Coq is not installed (Debian packages coq, ");
    const Outcome one = says(here.verify({file}), 2, {"stable         proved", missing, "equilibrium    undecided"});
    BOOST_TEST(!contains(one.out, "coq            proved"));
    for (const std::string name : {"pegs", "slot", "channel", "lattice"}) { // fixed disks and walls, cells
        run({"certify", ISOSTAT_TEST_DATA "/coq/" + name + ".json", "-o", here.folder.at(name)});
        says(here.verify({here.folder.at(name)}), 2, {"stable         proved", missing});
    }
    says(run({"verify", file}), 0, {"equilibrium    proved"});
    says(run({"verify", "--coq", file}, "PATH=/nowhere "), 2, {undecided_because("no answer from ")});
    const std::string extracted = undecided_because("Coq is not installed (Debian packages coq, ", "coq-extracted  ");
    says(here.verify({file}, "--coq-extracted"), 2, {"stable         proved", extracted, "equilibrium    undecided"});
    says(here.verify({file, "--coq-extracted"}), 2, {missing, extracted});
    expect(run({"verify", file, "--coq-limit", "3"}), 64, {"--coq"});
    for (const char* const checker : {"--coq", "--coq-extracted"}) {
        expect(run({"verify", here.folder.at("bin"), checker}), 64, {checker});
    }
}

/// Coq and OCaml would read other libraries there.
BOOST_AUTO_TEST_CASE(coq_sees_no_variables_that_name_libraries) {
    const WithoutCoq here;
    const std::string file = here.certificate(crafted::two_disks(1, 2, 1, 1), "two.json");
    scratch::write(here.folder.at("bin/coqc"), "#!/bin/sh\n/usr/bin/env >'" + here.folder.at("seen") + "'\n");
    std::filesystem::permissions(here.folder.at("bin/coqc"), std::filesystem::perms::owner_all);
    const std::string others = "OCAMLPATH=/other XDG_DATA_HOME=/other XDG_DATA_DIRS=/other COQLIB=/other ";
    says(run({"verify", "--coq", file}, others + here.path), 2, {undecided_because("MathComp is not installed for ")});
    if (std::filesystem::exists(here.folder.at("seen"))) { // asked
        const std::string seen = scratch::read(here.folder.at("seen"));
        BOOST_TEST(contains(seen, "PATH="));
        BOOST_TEST(!contains(seen, "/other"), seen);
    }
}

BOOST_AUTO_TEST_CASE(packings_that_the_checker_in_coq_does_not_cover_are_named) {
    const WithoutCoq here;
    isostat::State true_stress = crafted::two_disks(1, 2, 1, 1);
    true_stress.load.kind = isostat::LoadKind::true_stress;
    // As a contact the bar of touching members would bear the same thrust: another packing, with the same numbers.
    isostat::State touching_dimer = crafted::two_disks(1, 2, 1, 1);
    touching_dimer.packing.bars = {{0, 1, 3}};
    touching_dimer.contacts[static_cast<std::size_t>(std::ranges::find(touching_dimer.contacts, crafted::pair(0, 1)) -
                                                     touching_dimer.contacts.begin())] = {isostat::ContactKind::bar, 0,
                                                                                          1};
    isostat::State pinned = isostat::read_any_state(ISOSTAT_EXAMPLES "/cells/tilted-100.json").state;
    isostat::State isotropic = pinned;
    isotropic.packing.cell.keep_shape();
    pinned.packing.cell.pin = 30; // a rattler
    const std::vector<std::pair<std::string, std::string>> cases{
        {here.certificate(isotropic, "isotropic"), "isotropic cells"},
        {here.certificate(pinned, "pinned"), "cells whose pinned disk bears no force"},
        {here.certificate(touching_dimer, "clumps"), "clumps"},
        {here.certificate(true_stress, "true"), "true stresses"},
    };
    for (const auto& [file, words] : cases) {
        const Outcome outcome = here.verify({file});
        BOOST_TEST(outcome.status != 0);
        BOOST_TEST(contains(outcome.out, undecided_because("the checker in Coq does not cover " + words)),
                   words << ": " << outcome.out << outcome.err);
    }
}

BOOST_AUTO_TEST_CASE(several_certificates_are_verified_one_after_the_other) {
    const WithoutCoq here;
    const std::string good = here.certificate(crafted::two_disks(1, 2, 1, 1), "good");
    isostat::Certificate forged = isostat::read_certificate(good);
    forged.claims.gaps->smallest *= 2;
    isostat::write_certificate(here.folder.at("forged"), forged);
    expect(run({"verify", good, good}), 0);
    expect(run({"verify", good, here.folder.at("nothing")}), 65, {"nothing"});
    says(run({"verify", here.folder.at("forged"), good}), 1, {"equilibrium    refuted", "equilibrium    proved"});
    const auto answer = json_of(run({"verify", good, good, "--json"}));
    BOOST_TEST(answer["certificates"][1]["verdict"] == "proved");
    BOOST_TEST(answer["verdict"] == "proved");
    expect(run({"verify", good, good, "--input", good}), 64, {"--input"});
}
