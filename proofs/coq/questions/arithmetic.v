(** Arithmetic on numbers around the largest that Zarith keeps in a machine word. Coq prints the results; those of the
    extracted program have to be the same (check_extraction.py). *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ.
From Data Require integers_in_zarith.
Local Open Scope Z_scope.

Definition samples : seq Z :=
  let sizes := [:: 0; 1; 2; 3; 2 ^ 31; 2 ^ 62 - 1; 2 ^ 62; 2 ^ 62 + 1; 2 ^ 63; 2 ^ 64; 3 ^ 80] in sizes ++ [seq - a | a <- sizes].
Definition bit (b : bool) : Z := if b then 1 else 0.
Definition of_integers (a b : Z) : seq Z :=
  [:: a + b; a - b; a * b; - a; Z.abs a; Z.max a b; Z.min a b; a / b; bit (a =? b); bit (a <=? b); bit (a <? b);
      bit ((a <=? 0) && (b <? 2)); bit ((a <=? 0) || (b <? 2)); Z.of_N (Z.to_N a);
      let m := Z.to_N a in let k := Z.to_N b in bit (N.eqb m k) + 2 * bit (N.ltb m k) + 4 * bit (N.leb m k)].
Definition of_naturals (i j : nat) : seq nat :=
  [:: i + j; i - j; i * j; i.*2; i.-1; i.+1; nat_of_bool (i == j); nat_of_bool (i < j); maxn i j; i ^ 2; nat_of_bool (odd i);
      Z.to_nat (Z.of_nat i - Z.of_nat j); N.to_nat (N.of_nat i); absz (int_of_Z (Z.of_nat i - Z.of_nat j))]%N.
Definition results : seq Z :=
  flatten [seq of_integers a b | a <- samples, b <- samples]
  ++ [seq Z.of_nat i | i <- flatten [seq of_naturals i j | i <- iota 0 6, j <- iota 0 6]].

Eval vm_compute in results.
Extraction "arithmetic.ml" results.
