(** Matrices as lists of rows of binary integers, so that products can be computed inside Coq. Zeros are stored and
    skipped: a product costs one pass over a row for each entry that is not zero. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify.
From Isostat Require Import certificate contact_certificate.
Set Implicit Arguments.
Unset Strict Implicit.
Import GRing.Theory.

(** Adds a to entry k. *)
Fixpoint put (k : nat) (a : Z) (row : seq Z) : seq Z :=
  match k, row with
  | _, [::] => [::]
  | 0, b :: rest => Z.add b a :: rest
  | k'.+1, b :: rest => b :: put k' a rest
  end.
Definition put_all (entries : seq (nat * Z)) (row : seq Z) : seq Z := foldr (fun e => put e.1 e.2) row entries.
Definition dense (m : nat) (entries : seq (nat * Z)) : seq Z := put_all entries (nseq m Z0).

Fixpoint combine (m : nat) (coefficients : seq Z) (rows : table) : seq Z :=
  match coefficients, rows with
  | a :: rest, row :: rows' =>
      if Z.eqb a Z0 then combine m rest rows' else add_multiple a row (combine m rest rows')
  | _, _ => nseq m Z0
  end.

Definition transpose (m : nat) (rows : table) : table :=
  foldr (fun row columns => [seq e.1 :: e.2 | e <- zip row columns]) (nseq m [::]) rows.

Local Open Scope ring_scope.

Lemma put_entry k a row j : size (put k a row) = size row /\
  ((j < size row)%N -> nth 0 (put k a row) j = nth 0 row j + (if k == j then a else 0)).
Proof.
elim: row k j => [|b row IH] k j; first by case: k.
have [sIH entry] := IH k.-1 j.-1; case: k sIH entry => [|k] /= sIH entry; first by case: j {entry} => [|j]; rewrite /= ?addr0.
by rewrite sIH; case: j entry => [|j] //= _; split=> //; rewrite addr0.
Qed.

Lemma put_all_entry entries row j : size (put_all entries row) = size row /\
  ((j < size row)%N -> nth 0 (put_all entries row) j = nth 0 row j + \sum_(e <- entries | e.1 == j) e.2).
Proof.
elim: entries => [|e entries [IHs IH]]; first by split=> // _; rewrite big_nil addr0.
have [s rest] := put_entry e.1 e.2 (put_all entries row) j; split; first by rewrite -IHs.
move=> small; rewrite big_cons [nth _ _ _]rest ?IHs // IH // -addrA; congr (_ + _).
by case: ifP => _; rewrite ?addr0 // addrC.
Qed.

Lemma size_dense m entries : size (dense m entries) = m.
Proof. by have [-> _] := put_all_entry entries (nseq m 0) 0; rewrite size_nseq. Qed.
Lemma dense_entry m entries j : (j < m)%N -> nth 0 (dense m entries) j = \sum_(e <- entries | e.1 == j) e.2.
Proof.
have [_ rest] := put_all_entry entries (nseq m 0) j => jm.
by rewrite [nth _ _ _]rest ?size_nseq // nth_nseq if_same add0r.
Qed.

Lemma combine_entry m k coefficients rows : size coefficients = k -> size rows = k ->
  all (fun row => size row == m) rows ->
  size (combine m coefficients rows) = m /\
  forall j, nth 0 (combine m coefficients rows) j = \sum_(i < k) nth 0 coefficients i * nth 0 (nth [::] rows i) j.
Proof.
elim: k coefficients rows => [|k IH] [|a c] [|row rows] //=.
  by move=> _ _ _; rewrite size_nseq; split=> // j; rewrite big_ord0 nth_nseq if_same.
move=> [sc] [sr] /andP[/eqP s0 /(IH _ _ sc sr)[s rest]].
case: Z.eqb_spec => [->|_].
  by split=> // j; rewrite big_ord_recl /= mul0r add0r rest.
have [-> entry] := add_multiple_entry a s0 s; split=> // j.
by rewrite entry big_ord_recl /= rest.
Qed.

Lemma transpose_row m rows i : all (fun row => size row == m) rows ->
  size (transpose m rows) = m /\
  ((i < m)%N -> nth [::] (transpose m rows) i = [seq nth 0 row i | row <- rows]).
Proof.
elim: rows => [_|row rows IH /= /andP[/eqP s0 /IH[s rest]]].
  by rewrite /= size_nseq; split=> // im; rewrite nth_nseq im.
rewrite size_map size_zip s s0 minnn; split=> // im.
by rewrite (nth_map (0, [::])) ?size_zip ?s ?s0 ?minnn // nth_zip ?s ?s0 //= rest.
Qed.

(** Entry j of row i of the product of two square tables, the first given by its rows. *)
Lemma product_row m (X Y : table) (i j : 'I_m) : size X = m -> size Y = m -> all (fun row => size row == m) X ->
  all (fun row => size row == m) Y -> nth 0 (combine m (nth [::] X i) Y) j = (of_rows m X *m of_rows m Y) i j.
Proof.
move=> sX sY /allP aX aY; have sXi : size (nth [::] X i) = m by apply/eqP/aX/mem_nth; rewrite sX.
have [_ ->] := combine_entry sXi sY aY; rewrite mxE; apply: eq_bigr => k _; by rewrite !mxE.
Qed.

Lemma transpose_rows m (X : table) : size X = m -> all (fun row => size row == m) X ->
  [/\ size (transpose m X) = m, all (fun row => size row == m) (transpose m X)
    & of_rows m (transpose m X) = (of_rows m X)^T].
Proof.
move=> sX aX; have [sT _] := transpose_row 0 aX; split=> //.
  apply/(all_nthP [::]) => i; rewrite sT => im.
  by have [_ ->] := transpose_row i aX; rewrite ?size_map ?sX.
apply/matrixP=> i j; rewrite !mxE; have [_ ->] := transpose_row i aX; rewrite ?ltn_ord //.
by rewrite (nth_map [::]) // sX.
Qed.

Print Assumptions product_row.
Print Assumptions transpose_rows.
