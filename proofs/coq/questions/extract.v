(** The check of load_certificate.v as a program in OCaml: checker.ml, compiled with ../extracted/program.ml by prove.py.

    The theorem is about [load_check] itself, as Coq has it. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import contact_certificate box_certificate equilibrium_certificate load_certificate.
From Data Require integers_in_zarith.

(** What the program reads, and what it prints: the values that verdict.v prints, in the same order. *)
Definition vertex_of := VertexCertificate.
Definition solution_of := ForceSolution.
Definition claim_of := ForceClaim.
Definition end_of := LoadEnd.
Definition certificate_of v f g zeros unloaded gap := LoadCertificate (EquilibriumCertificate v f g zeros unloaded gap).

Inductive shown := Number of Z | Numbers of seq Z | Natural of nat | Naturals of seq nat | Flags of seq bool | Contacts of seq contact.
Definition of_claim (p : force_claim) : seq shown := [:: Numbers (load p); Numbers (low p); Numbers (high p)].
Definition of_end (x : load_end) : seq shown := [:: Naturals (seq_of_opt (opens x)); Numbers [:: near x; far x]].
Definition statement (whole : load_certificate) : seq shown :=
  let c := equilibrium whole in let v := vertex c in
  [:: Natural (lies_in v); Natural (disks v); Contacts (contacts v); Flags (walls v); Flags (periodic v); Numbers (stored v); Numbers (radii v);
      Number (zoom v); Number (distance v); Number (ball v)]
  ++ of_claim (finite c) ++ Flags (zeros c) :: of_claim (infinitesimal c)
  ++ [:: Number (gap c); Numbers (load (rate whole)); Number (stress whole)]
  ++ of_end (lower_end whole) ++ of_end (upper_end whole).

Print Assumptions equilibrium_with_its_interval.
Extraction "checker.ml" load_check statement vertex_of solution_of claim_of end_of certificate_of.
