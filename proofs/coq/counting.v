(** Statement T1 (../counting.md): counting, orthogonality, virtual power.

    Conventions. G is the N x Nf matrix that maps velocities to approach velocities. Forces and loads
    are rows, so that the load balanced by the forces f is [f *m G], which is H f written as a row
    (H = G^T); velocities are columns, and the approach velocities of v are [G *m v].
    [kermx G] is a matrix whose rows span the self-stresses S0, [kermx G^T] the mechanisms M. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Import GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Counting.
Variables (F : fieldType) (N Nf : nat).
Implicit Type G : 'M[F]_(N, Nf).

Definition hyperstaticity G := \rank (kermx G).
Definition mechanisms G := \rank (kermx G^T).

Theorem counting G : (Nf + hyperstaticity G = N + mechanisms G)%N.
Proof.
rewrite /hyperstaticity /mechanisms !mxrank_ker mxrank_tr.
have := rank_leq_row G; have := rank_leq_col G => hc hr.
by rewrite !addnBA // addnC.
Qed.

(** The approach velocities that some motion realises are the vectors orthogonal to every self-stress: C = S0^perp. *)
Theorem compatible_iff_orthogonal_to_self_stresses G (dV : 'cV[F]_N) :
  (exists v : 'cV_Nf, dV = G *m v) <-> (forall s : 'rV_N, s *m G = 0 -> s *m dV = 0).
Proof.
split=> [[v ->] s sG0|ort]; first by rewrite mulmxA sG0 mul0mx.
have sub : (dV^T <= G^T)%MS.
  have: (kermx G *m dV = 0).
    apply/row_matrixP=> i; rewrite row_mul row0; apply: ort.
    by rewrite -row_mul mulmx_ker row0.
  move=> k0; have: (dV^T *m (kermx G)^T = 0) by rewrite -trmx_mul k0 trmx0.
  move=> kk0.
  have le: (G^T <= kermx (kermx G)^T)%MS by apply/sub_kermxP; rewrite -trmx_mul mulmx_ker trmx0.
  have eqr: \rank G^T = \rank (kermx (kermx G)^T).
    by rewrite mxrank_ker !mxrank_tr mxrank_ker subKn // rank_leq_row.
  have eqm : (G^T == kermx (kermx G)^T)%MS by rewrite -(mxrank_leqif_eq le) eqr.
  by rewrite (eqmxP eqm); apply/sub_kermxP.
case/submxP: sub => w Ew; exists w^T.
by rewrite -[LHS]trmxK Ew trmx_mul trmxK.
Qed.

(** The loads that the structure can carry (with forces of any sign) are those that do no work in any mechanism. *)
Theorem supported_iff_orthogonal_to_mechanisms G (load : 'rV[F]_Nf) :
  (exists f : 'rV_N, load = f *m G) <-> (forall v : 'cV_Nf, G *m v = 0 -> load *m v = 0).
Proof.
split=> [[f ->] v Gv0|ort]; first by rewrite -mulmxA Gv0 mulmx0.
have: (load <= G)%MS.
  have le: (G <= kermx (kermx G^T)^T)%MS.
    by apply/sub_kermxP; rewrite -[G in G *m _]trmxK -trmx_mul mulmx_ker trmx0.
  have eqr: \rank G = \rank (kermx (kermx G^T)^T).
    by rewrite mxrank_ker !mxrank_tr mxrank_ker mxrank_tr subKn // rank_leq_col.
  have eqm : (G == kermx (kermx G^T)^T)%MS by rewrite -(mxrank_leqif_eq le) eqr.
  rewrite (eqmxP eqm); apply/sub_kermxP/trmx_inj; rewrite trmx_mul trmxK trmx0.
  apply/row_matrixP=> i; rewrite row_mul row0.
  apply/trmx_inj; rewrite trmx_mul trmxK trmx0; apply: ort.
  by apply/trmx_inj; rewrite trmx_mul trmxK trmx0 -row_mul mulmx_ker row0.
by case/submxP=> f ->; exists f.
Qed.

(** Virtual power, equation (2) of the paper: it holds for H = G^T and for no other matrix. *)
Theorem virtual_power G (f : 'rV[F]_N) (v : 'cV[F]_Nf) : f *m (G *m v) = (f *m G) *m v.
Proof. exact: mulmxA. Qed.

Theorem virtual_power_forces_transpose G (H : 'M[F]_(Nf, N)) :
  (forall (f : 'rV[F]_N) (v : 'cV[F]_Nf), f *m (G *m v) = (H *m f^T)^T *m v) -> H = G^T.
Proof.
move=> power; apply/trmx_inj; rewrite trmxK; apply/matrixP=> l mu.
have := power (delta_mx 0 l) (delta_mx mu 0).
rewrite -colE -!rowE trmx_mul trmxK -rowE.
move/matrixP/(_ 0 0).
by rewrite -colE !mxE => ->.
Qed.
End Counting.

(** Over an ordered field S0 and C are supplementary: their intersection is zero (their dimensions add up by
  counting). *)
Theorem self_stresses_meet_compatible_in_zero (F : realFieldType) N Nf (G : 'M[F]_(N, Nf)) (s : 'rV_N) (v : 'cV_Nf) :
  s *m G = 0 -> s^T = G *m v -> s = 0.
Proof.
move=> sG0 Es; have ss0 : s *m s^T = 0 by rewrite Es mulmxA sG0 mul0mx.
apply/rowP=> l; rewrite mxE.
move/matrixP/(_ 0 0): ss0; rewrite !mxE => /eqP.
rewrite psumr_eq0; last by move=> i _; rewrite mxE -expr2 sqr_ge0.
by move=> /allP/(_ l (mem_index_enum _)); rewrite mxE -expr2 sqrf_eq0 => /eqP.
Qed.

Print Assumptions counting.
Print Assumptions compatible_iff_orthogonal_to_self_stresses.
Print Assumptions supported_iff_orthogonal_to_mechanisms.
Print Assumptions virtual_power.
Print Assumptions virtual_power_forces_transpose.
Print Assumptions self_stresses_meet_compatible_in_zero.
