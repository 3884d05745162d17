(** Binary integers as elements of an ordered field: sums, products, order and size are kept. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Embedding.
Variable F : realFieldType.
Definition real (z : Z) : F := (int_of_Z z)%:~R.
Lemma real_is_rmorphism : rmorphism real.
Proof. by do ?split=> [x y|]; rewrite /real ?rmorphB ?rmorphM. Qed.
Canonical real_additive := Additive real_is_rmorphism.
Canonical real_rmorphism := RMorphism real_is_rmorphism.
Lemma real_morphism z : real_rmorphism z = real z. Proof. by []. Qed.

Lemma real_zero : real Z0 = 0. Proof. exact: rmorph0. Qed.
Lemma real_plus x y : real (Z.add x y) = real x + real y. Proof. exact: rmorphD. Qed.
Lemma real_minus x y : real (Z.sub x y) = real x - real y. Proof. exact: rmorphB. Qed.
Lemma real_times x y : real (Z.mul x y) = real x * real y. Proof. exact: rmorphM. Qed.

Lemma real_le x y : (real x <= real y) = Z.leb x y.
Proof. by rewrite /real ler_int; lia. Qed.
Lemma real_lt x y : (real x < real y) = Z.ltb x y.
Proof. by rewrite /real ltr_int; lia. Qed.
Lemma real_abs x : `|real x| = real (Z.abs x).
Proof. by rewrite /real -intr_norm; congr (_%:~R); lia. Qed.
Lemma real_of_nat m : real (Z.of_nat m) = m%:R.
Proof. by rewrite /real pmulrn; congr (_%:~R); lia. Qed.
Lemma real_eq0 x : (real x == 0) = Z.eqb x 0.
Proof. by rewrite /real intr_eq0; lia. Qed.
End Embedding.
Arguments real {F}.

Print Assumptions real_le.
Print Assumptions real_abs.
