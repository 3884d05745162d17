(** Statement T4 (../rank_mod_p.md): the rank does not increase under a ring morphism,
  hence full rank modulo p is full rank. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** A matrix has rank >= r iff some r x r minor is not zero. *)
Lemma rank_has_minor (F : fieldType) (m n : nat) (A : 'M[F]_(m, n)) :
  exists (f : 'I_(\rank A) -> 'I_m) (g : 'I_(\rank A) -> 'I_n), \det (mxsub f g A) != 0.
Proof.
set B := rowsub (maxrankfun A) A.
have freeB : row_free B := maxrowsub_free A.
have fullB : row_full B^T by rewrite /row_full mxrank_tr.
exists (maxrankfun A), (fullrankfun fullB).
have : (rowsub (fullrankfun fullB) B^T) \in unitmx by rewrite fullrowsub_unit.
rewrite -unitmx_tr unitmxE unitfE; congr (\det _ != 0).
by apply/matrixP=> i j; rewrite !mxE.
Qed.

Lemma minor_bounds_rank (F : fieldType) (m n r : nat) (A : 'M[F]_(m, n)) (f : 'I_r -> 'I_m) (g : 'I_r -> 'I_n) :
  \det (mxsub f g A) != 0 -> (r <= \rank A)%N.
Proof.
move=> minor; have unit : mxsub f g A \in unitmx by rewrite unitmxE unitfE.
have -> : r = \rank (mxsub f g A) by rewrite mxrank_unit.
have -> : mxsub f g A = rowsub f A *m (colsub g 1%:M).
  apply/matrixP=> i j; rewrite !mxE (bigD1 (g j)) //= !mxE eqxx mulr1 big1 ?addr0 // => k nk.
  by rewrite !mxE (negPf nk) mulr0.
apply: leq_trans (mxrankM_maxl _ _) _; apply: mxrankS; exact: rowsub_sub.
Qed.

Section Morphisms.
Variables (R : comRingType) (K F : fieldType).
Variables (into : {rmorphism R -> K}) (phi : {rmorphism R -> F}).
Hypothesis into_inj : injective into.

Theorem rank_does_not_increase (m n : nat) (A : 'M[R]_(m, n)) : (\rank (map_mx phi A) <= \rank (map_mx into A))%N.
Proof.
have [f [g minor]] := rank_has_minor (map_mx phi A).
apply: (@minor_bounds_rank _ _ _ _ _ f g).
have sub (S : fieldType) (psi : {rmorphism R -> S}) : mxsub f g (map_mx psi A) = map_mx psi (mxsub f g A).
  by apply/matrixP=> i j; rewrite !mxE.
rewrite sub det_map_mx; rewrite sub det_map_mx in minor.
apply: contraNneq minor => d0.
have -> : \det (mxsub f g A) = 0 by apply: into_inj; rewrite d0 rmorph0.
by rewrite rmorph0.
Qed.

Corollary full_rank_lifts (m n : nat) (A : 'M[R]_(m, n)) :
  \rank (map_mx phi A) = minn m n -> \rank (map_mx into A) = minn m n.
Proof.
move=> full; apply/eqP; rewrite eqn_leq -{2}full rank_does_not_increase andbT.
by rewrite leq_min rank_leq_row rank_leq_col.
Qed.
End Morphisms.

(** Integers and the field of p elements. *)
Theorem rank_mod_p_is_a_lower_bound (p m n : nat) (A : 'M[int]_(m, n)) :
  (\rank (map_mx (intr : int -> 'F_p) A) <= \rank (map_mx (intr : int -> rat) A))%N.
Proof. exact: (@rank_does_not_increase _ _ _ [rmorphism of intr] [rmorphism of intr] (@intr_inj _)). Qed.

(** Rows multiplied by numbers that are not zero (lengths of the centre lines): the rank is that of the unit-normal
  matrix. *)
Theorem rank_of_scaled_rows (F : fieldType) (m n : nat) (A : 'M[F]_(m, n)) (d : 'rV[F]_m) :
  (forall i, d 0 i != 0) -> \rank (diag_mx d *m A) = \rank A.
Proof.
move=> nz.
have unit : diag_mx d \in unitmx by rewrite unitmxE det_diag unitfE; apply/prodf_neq0 => i _.
by rewrite -mxrank_tr trmx_mul mxrankMfree ?mxrank_tr // row_free_unit unitmx_tr.
Qed.

Print Assumptions rank_does_not_increase.
Print Assumptions full_rank_lifts.
Print Assumptions rank_mod_p_is_a_lower_bound.
Print Assumptions rank_of_scaled_rows.
