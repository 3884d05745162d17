#include "answers/state.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "io/files.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <filesystem>

namespace isostat::cli {

int certify(const CertifyArguments& arguments) {
    const std::filesystem::path input = arguments.input;
    check_output(arguments.output, "\"isostat-certificate\"", {input});
    Certificate certificate;
    certificate.input = input.filename().string();
    certificate.input_hash = sha256(read_text(input));
    certificate.program = program_name();
    StateFile file = read_any_state(input, Dimensions::any_bodies);
    file.state = with_free_motions_held(std::move(file.state));
    certificate.state = file.state;
    Certification result = isostat::certify(certificate.state);
    certificate.claims = result.claims;
    const compare::Untold untold = compare::untold_by(compare::imported_rounding(file.state), file.state, result);
    const Verdict verdict = withheld(untold, result.verdict);
    write_certificate(arguments.output, certificate);
    answers::Answer answer{.width = 14};
    answer.item("file", arguments.input);
    answers::add_claims(answer, result, certificate.state.contacts);
    answers::add_forces_in_file(answer, file, result);
    answers::add_untold(answer, untold, result.verdict);
    answer.item("certificate", arguments.output);
    answer.item("verdict", to_string(verdict), std::string(to_string(verdict)), "{}: {}",
                verdict == Verdict::proved && result.claims.minimum
                    ? "an equilibrium without overlap, not isostatic, stable along its mechanisms"
                : verdict == Verdict::proved  ? "an isostatic, stable equilibrium without overlap at the true vertex"
                : verdict == Verdict::refuted ? "not such an equilibrium"
                : untold.any()                ? fmt::format("the claims are of the stored doubles; {}", untold.words())
                                              : "some claims could not be made",
                arguments.output);
    print(std::move(answer), arguments.common);
    return status_of(verdict);
}

} // namespace isostat::cli
