(** Lists of binary integers as vectors: numbers are added to entries, by name. *)
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

Print Assumptions dense_entry.
