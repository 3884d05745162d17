(** A checker for certificates of full rank, and its correctness (statement T4, ../rank_mod_p.md).

    The certificate of a square integer matrix A is a modulus p > 1 and a matrix B with A B = 1 modulo p. The check uses binary integers
    and lists only, so that it can be run inside Coq. Nothing is asked of p but p > 1: primality would only help to find B. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify.
Set Implicit Arguments.
Unset Strict Implicit.
Import GRing.Theory Num.Theory.

Definition table := seq (seq Z).

Fixpoint dot (x y : seq Z) : Z :=
  match x, y with
  | a :: x', b :: y' => Z.add (Z.mul a b) (dot x' y')
  | _, _ => Z0
  end.

(** [rows] are those of A, [columns] those of B. *)
Definition entry_ok (p : Z) (i j : nat) (row column : seq Z) : bool :=
  Z.eqb (Z.modulo (Z.sub (dot row column) (if i == j then Zpos xH else Z0)) p) Z0.

Definition check (n : nat) (p : Z) (rows columns : table) : bool :=
  [&& Z.ltb (Zpos xH) p, size rows == n, size columns == n, all (fun r => size r == n) rows, all (fun c => size c == n) columns
    & all (fun i => all (fun j => entry_ok p i j (nth [::] rows i) (nth [::] columns j)) (iota 0 n)) (iota 0 n)].

Local Open Scope ring_scope.
Definition of_rows (n : nat) (t : table) : 'M[Z]_n := \matrix_(i, j) nth 0 (nth [::] t i) j.

Lemma dot_is_sum (n : nat) (x y : seq Z) : size x = n -> size y = n -> dot x y = \sum_(k < n) nth 0 x k * nth 0 y k.
Proof.
elim: n x y => [|n IH] [|a x] [|b y] //= => [_ _|[sx] [sy]]; first by rewrite big_ord0.
by rewrite big_ord_recl /= (IH x y).
Qed.

(** Reduction modulo p as a ring morphism to Z/p. *)
Definition residue (p : nat) (z : Z) : 'Z_p := (int_of_Z z)%:~R.

Lemma residue_of_multiple (p : nat) (z : Z) : (1 < p)%N -> Z.modulo z (Z.of_nat p) = Z0 -> residue p z = 0.
Proof.
move=> p1 /Z.mod_divide; case; first by lia.
move=> q ->; rewrite /residue.
have -> : int_of_Z (Z.mul q (Z.of_nat p)) = int_of_Z q * (p : int).
  by rewrite -[in RHS](Z_of_intK (p : int)) -rmorphM.
by rewrite intrM -pmulrn char_Zp ?mulr0.
Qed.

(** An inverse modulo p proves that an integer matrix is regular; 1 < p is all that is asked of p. *)
Lemma inverse_modulo_proves_regular (n : nat) (p : Z) (A B : 'M[Z]_n) :
  Z.lt (Zpos xH) p ->
  (forall i j, Z.modulo (Z.sub ((A *m B) i j) (if i == j then Zpos xH else Z0)) p = Z0) -> \det A != 0.
Proof.
move=> p1 ok.
pose q := Z.to_nat p; have q1 : (1 < q)%N by rewrite /q; lia.
have pq : p = Z.of_nat q by rewrite /q; lia.
pose phi : {rmorphism Z -> 'Z_q} := [rmorphism of (intr : int -> 'Z_q) \o int_of_Z].
have prod : map_mx phi (A *m B) = 1%:M.
  apply/matrixP=> i j; have := ok i j; rewrite pq => /(residue_of_multiple q1) zero; rewrite [LHS]mxE [RHS]mxE.
  set s := (A *m B) i j in zero *.
  have : phi s - phi (if i == j then Zpos xH else Z0) = 0 by rewrite -rmorphB -[RHS]zero.
  by move/eqP; rewrite subr_eq0 => /eqP ->; case: eqP => _; rewrite ?rmorph1 ?rmorph0.
apply/eqP => d0.
have : phi (\det (A *m B)) = 1 by rewrite -det_map_mx prod det1.
rewrite det_mulmx d0 mul0r rmorph0 => /eqP.
by rewrite eq_sym oner_eq0.
Qed.

Theorem check_proves_regular (n : nat) (p : Z) (rows columns : table) :
  check n p rows columns -> \det (of_rows n rows) != 0.
Proof.
case/and5P=> /Z.ltb_lt p1 /eqP sr /eqP sc /allP ar /andP[/allP ac /allP ok].
apply: (@inverse_modulo_proves_regular n p _ (of_rows n columns)^T p1) => i j.
have in_n (k : 'I_n) : nat_of_ord k \in iota 0 n by rewrite mem_iota ltn_ord.
have /allP/(_ _ (in_n j)) := ok _ (in_n i); rewrite /entry_ok => /Z.eqb_eq.
have rs : size (nth [::] rows i) = n by apply/eqP/ar/mem_nth; rewrite sr.
have cs : size (nth [::] columns j) = n by apply/eqP/ac/mem_nth; rewrite sc.
rewrite (dot_is_sum rs cs) => zero; rewrite -[RHS]zero mxE; congr (Z.modulo (Z.sub _ _) _).
by apply: eq_bigr => k _; rewrite !mxE.
Qed.

(** Regular over Z is regular over every field of characteristic 0. *)
Lemma regular_over_characteristic_0 (F : numFieldType) (n : nat) (A : 'M[Z]_n) :
  \det A != 0 -> map_mx (fun z => (int_of_Z z)%:~R : F) A \in unitmx.
Proof.
pose psi : {rmorphism Z -> F} := [rmorphism of (intr : int -> F) \o int_of_Z].
move=> d; rewrite unitmxE unitfE -[map_mx _ _]/(map_mx psi A) det_map_mx.
apply: contraNneq d => /= /eqP; rewrite intr_eq0 => /eqP E.
by apply/eqP/(can_inj int_of_ZK); rewrite E.
Qed.

(** Full rank over the rational numbers: that of the matrix of a stored (dyadic, rescaled) configuration. *)
Corollary check_proves_full_rank (n : nat) (p : Z) (rows columns : table) :
  check n p rows columns -> \rank (map_mx (fun z => (int_of_Z z)%:~R : rat) (of_rows n rows)) = n.
Proof. by move=> /check_proves_regular/(@regular_over_characteristic_0 [numFieldType of rat])/mxrank_unit. Qed.

Print Assumptions check_proves_regular.
Print Assumptions check_proves_full_rank.
