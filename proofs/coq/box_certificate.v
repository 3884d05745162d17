(** The certificate of a vertex in a box or a cell, as integers, and the check that Coq evaluates.

    Lengths of the stored packing are multiples of a unit; the refined configuration is given in a unit that is
    [zoom] times smaller. The check computes A^T A - s I - L L^T of the stored configuration exactly (K15), and the
    gaps of the refined one; box_vertex.v does the rest. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify ring.
From Isostat Require Import contact_certificate sparse_rows integers_in_a_field shifted_factor max_norm box
  box_vertex.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.

Record vertex_certificate := VertexCertificate {
  lies_in : dimension;
  disks : nat;                (* spheres in space *)
  contacts : seq contact;     (* and the coordinates that are held: as many rows as coordinates *)
  walls : seq bool;           (* which there are: the lower ones, the upper ones *)
  periodic : seq bool;        (* which axes are *)
  stored : seq Z;             (* coordinates of the grains, lengths, tilts *)
  radii : seq Z;
  weight : Z;                 (* a length: rows of walls are multiplied by it *)
  zoom : Z;
  refined : seq Z;            (* coordinates, in the smaller unit *)
  error : Z;                  (* the true vertex is so near the refined one, in the smaller unit *)
  distance : Z;               (* and so near the stored one, in the smaller unit *)
  ball : Z;                   (* there is no other vertex so near the stored one *)
  stiffness : Z;              (* |A x| >= stiffness |x| for the largest entries *)
  shift : Z;
  factor : seq (seq (Z * Z))  (* columns of L: rows and entries *)
}.

Section Check.
Variable v : vertex_certificate.
Let d := lies_in v.
Let n := disks v.
Let N := (coordinates_of d n)%N.
Local Open Scope Z_scope.

Definition stored_at : nat -> Z := nth 0 (stored v).
Definition refined_at : nat -> Z := nth 0 (refined v).
Definition fine_radius (i : nat) : Z := zoom v * nth 0 (radii v) i.
Definition fine_place (k : nat) : Z := zoom v * stored_at k.
Definition fine_weight : Z := zoom v * weight v.
Definition fine_stiffness : Z := zoom v * stiffness v.

Definition matrix_rows : seq sparse := [seq sparse_of (gradient d n (weight v) stored_at c) | c <- contacts v].
Definition factor_columns : seq sparse := [seq [seq (Z.to_N e.1, e.2) | e <- column] | column <- factor v].
Definition defect_rows : seq sparse :=
  add_all_products 1 matrix_rows (add_all_products (-1) factor_columns (diagonal N (- shift v))).
Definition bend : Z := Z.of_nat (curvature d n (contacts v)).
Definition largest_defect : Z :=
  shift v - 2 * Z.of_nat N * (stiffness v * stiffness v + bend * bend * (ball v * ball v)).
Definition well_conditioned : bool := let most := largest_defect in all (fun row => sizes row <=? most) defect_rows.

Definition nearly_closed : bool :=
  all (fun c => Z.abs (doubled_gap d n fine_weight fine_radius fine_place refined_at c) <=? 2 * (fine_stiffness * error v)) (contacts v).
Definition near_the_stored_one : bool :=
  (distance v + error v <=? zoom v * ball v)
  && all (fun k => Z.abs (refined_at k - zoom v * stored_at k) + error v <=? distance v) (iota 0 N).

Definition well_posed : bool :=
  [&& (size (stored v) == N) && (size (refined v) == N), (size (radii v) == n) && all (Z.ltb 0) (radii v),
    (size (contacts v) == N) && all (in_the_packing d n (walls v) (periodic v)) (contacts v), size (factor v) == N
    & [&& 0 <? weight v, 0 <? zoom v & 0 <? stiffness v]].
Definition vertex_check : bool :=
  [&& well_posed, nearly_closed, near_the_stored_one, 4 * bend * error v <=? fine_stiffness & well_conditioned].
End Check.

Local Open Scope ring_scope.

Section Correct.
Variables (F : archiFieldType) (v : vertex_certificate).
Let d := lies_in v.
Let n := disks v.
Let N := (coordinates_of d n)%N.

Definition configuration (x : nat -> Z) : 'cV[F]_N := \col_k real (x k).
Definition stored_configuration := configuration (fine_place v).
Definition refined_configuration := configuration (refined_at v).
Definition radius (i : nat) : F := real (fine_radius v i).
Definition place (k : nat) : F := real (fine_place v k).

Hypothesis posed : well_posed v.
Let size_stored : size (stored v) = N. Proof. by case/and5P: posed => /andP[/eqP]. Qed.
Let size_refined : size (refined v) = N. Proof. by case/and5P: posed => /andP[_ /eqP]. Qed.
Let size_contacts : size (contacts v) = N. Proof. by case/and5P: posed => _ _ /andP[/eqP]. Qed.
Let size_factor : size (factor v) = N. Proof. by case/and5P: posed => _ _ _ /eqP. Qed.
Let positive : [/\ 0 < weight v, 0 < zoom v & 0 < stiffness v].
Proof. by case/and5P: posed => _ _ _ _ /and3P[]; split; lia. Qed.

Let at_configuration (x : nat -> Z) k : (forall k, (N <= k)%N -> x k = 0) -> at_ (configuration x) k = real (x k).
Proof.
move=> beyond; case: (ltnP k N) => kN; first by rewrite (at_ordinal _ (Ordinal kN)) mxE.
rewrite beyond // rmorph0 /at_ big1 // => m /eqP mk.
by have := ltn_ord m; rewrite mk ltnNge kN.
Qed.

Lemma at_refined k : at_ refined_configuration k = real (refined_at v k).
Proof. by apply: at_configuration => m big; rewrite /refined_at nth_default ?size_refined. Qed.
Lemma at_stored k : at_ stored_configuration k = real (zoom v) * real (stored_at v k).
Proof.
rewrite at_configuration /fine_place ?real_times // => m big.
by rewrite /stored_at nth_default ?size_stored ?Z.mul_0_r.
Qed.

Let A := derivative (real (fine_weight v) : F) (contacts v) : 'cV[F]_N -> 'M[F]_N.

Let B := matrix_of N (matrix_rows v).
Let L := (matrix_of N (factor_columns v))^T.

Lemma derivative_at_the_stored_one : A stored_configuration = real (zoom v) *: map_mx real B.
Proof.
have finer c : gradient d n (real (fine_weight v)) (at_ stored_configuration) c
    = [seq (e.1, real (zoom v) * real e.2 : F) | e <- gradient d n (weight v) (stored_at v) c].
  case: c => [i j k l m|i a|i a|k]; rewrite /gradient /= ?real_times ?rmorphN ?mulrN ?real_times // map_flatten -map_comp.
  congr flatten; apply: eq_map => a /=; rewrite -map_comp; apply: eq_map => e /=.
  by rewrite /separation (sum_at_scale _ at_stored) rmorphMz -mulrzAr (sum_at_morphism (real_rmorphism F)).
apply/matrixP=> l m; rewrite !mxE (nth_map (Lower 0 0)) ?size_contacts // sparse_of_entry.
by rewrite finer big_map rmorph_sum mulr_sumr.
Qed.

Let size_defect : size (defect_rows v) = N.
Proof. by rewrite /defect_rows !(proj1 (add_all_products_entry _ _ _ 0 0)) size_diagonal. Qed.

Let defect_entry (i j : 'I_N) : entry (nth [::] (defect_rows v) i) j = (B^T *m B - (shift v)%:M - L *m L^T) i j.
Proof.
have products (rows : seq sparse) : size rows = N ->
    \sum_(row <- rows) entry row i * entry row j = ((matrix_of N rows)^T *m matrix_of N rows) i j.
  by move=> sr; rewrite (big_nth [::]) sr big_mkord mxE; apply: eq_bigr => l _; rewrite !mxE.
rewrite /defect_rows (proj2 (add_all_products_entry _ _ _ _ _)) ?(proj1 (add_all_products_entry _ _ _ 0 0)) ?size_diagonal //.
rewrite (proj2 (add_all_products_entry _ _ _ _ _)) ?size_diagonal // diagonal_entry // !products ?size_map //.
have parts (X Y W : 'M[Z]_N) : (X - Y - W) i j = X i j - Y i j - W i j by rewrite !mxE.
rewrite /L trmxK parts [_%:M _ _]mxE.
rewrite -[Zneg xH]/(-1 : Z) mulN1r -[Zpos xH]/(1 : Z) mul1r -[i == j]/(nat_of_ord i == j).
move: ((_ *m _) i j) ((_ *m _) i j) => s t; by case: (_ == _); rewrite ?mulr1n ?mulr0n; ring.
Qed.

Let small_defect i : well_conditioned v ->
  \sum_j `|defect (map_mx real B : 'M[F]_N) (map_mx real L) (real (shift v)) i j| <= real (largest_defect v).
Proof.
move=> /(all_nthP [::])/(_ i); rewrite size_defect => /(_ (ltn_ord i)); rewrite -(real_le F); apply: le_trans.
apply: le_trans _ (@sizes_are_larger F (real_rmorphism F) N _ (@real_abs F)).
rewrite le_eqVlt; apply/orP; left; apply/eqP; apply: eq_bigr => j _; congr (`|_|).
by rewrite /= defect_entry /defect !map_trmx -!map_mxM -map_scalar_mx -!map_mxB mxE.
Qed.

Let q0 := stored_configuration.
Let q1 := refined_configuration.
Let b : F := real (fine_stiffness v).
Let rho : F := real (zoom v * ball v).

Let C : F := (curvature d n (contacts v))%:R.

Let strong x : well_conditioned v -> 2%:R * N%:R * (b ^+ 2 + C ^+ 2 * rho ^+ 2) * square x <= square (A q0 *m x).
Proof.
move=> well; have := shifted_factor_bounds_from_below (fun i => small_defect i well) x.
have [_ z0 _] := positive; have zz : 0 <= real (zoom v) ^+ 2 :> F by apply: sqr_ge0.
move=> /(ler_wpmul2l zz); rewrite derivative_at_the_stored_one -scalemxAl.
have -> : square (real (zoom v) *: (map_mx real B *m x)) = real (zoom v) ^+ 2 * square (map_mx real B *m x) :> F.
  by rewrite /square mulr_sumr; apply: eq_bigr => k _; rewrite mxE exprMn.
move=> bound; apply: le_trans _ bound; rewrite [X in _ <= X]mulrA ler_wpmul2r ?square_ge0 //.
have -> : largest_defect v = shift v - Z.of_nat 2 * Z.of_nat N * (stiffness v ^+ 2 + bend v ^+ 2 * ball v ^+ 2) by rewrite !expr2.
rewrite /b /rho /bend [fine_stiffness v](_ : _ = zoom v * stiffness v) // !(rmorphX, rmorphM, rmorphB, rmorphD).
rewrite !real_morphism !real_of_nat -/n -/C.
rewrite le_eqVlt; apply/orP; left; apply/eqP; ring.
Qed.

Let small : nearly_closed v -> norm (gaps (real (fine_weight v)) radius place (contacts v) q1) <= b * real (error v).
Proof.
move=> /(all_nthP (Lower 0 0)) closed; rewrite -rmorphM.
have bound l : `|gaps (real (fine_weight v)) radius place (contacts v) q1 l 0| <= real (fine_stiffness v * error v).
  have := closed l; rewrite size_contacts ltn_ord => /(_ isT); rewrite -(real_le F) -real_abs.
  rewrite -(doubled_gap_morphism (real_rmorphism F)) -[Z.mul _ _]/(Z.of_nat 2 * (fine_stiffness v * error v)).
  rewrite [real (Z.of_nat 2 * _)]rmorphM.
  rewrite !real_morphism real_of_nat mxE normrM ger0_norm ?invr_ge0 ?ler0n // ler_pdivr_mull ?ltr0n //.
  by rewrite (doubled_gap_ext _ _ _ _ _ _ at_refined).
by apply: norm_le => //; apply: le_trans (bound ord0).
Qed.

Let r : F := real (error v).
Let near_stored : near_the_stored_one v -> norm (q1 - q0) + r <= real (distance v).
Proof.
move=> /andP[_ /allP near]; have entry (k : 'I_N) : `|(q1 - q0) k 0| + r <= real (distance v).
  have := near (k : nat); rewrite mem_iota ltn_ord => /(_ isT).
  by rewrite -(real_le F) real_plus -real_abs rmorphB /= !mxE.
rewrite addrC -ler_subr_addl; apply: norm_le => [|k]; last by rewrite ler_subr_addl addrC.
by rewrite subr_ge0; apply: le_trans (entry ord0); rewrite ler_addr.
Qed.

Let inside : near_the_stored_one v -> real (distance v) + r <= rho.
Proof. by case/andP=> sum _; rewrite -real_plus real_le. Qed.

Lemma scales_are_positive (l : nat) : 0 < scale 1 radius (contact_at (contacts v) l).
Proof.
case/and5P: posed => _ /andP[/eqP sR /all_nthP pR] /andP[_ /all_nthP formed] _ _; have [_ z0 _] := positive.
have radius_gt0 i : (i < n)%N -> 0 < radius i.
  move=> i_n; have := pR 0 i; rewrite sR => /(_ i_n) Ri.
  by rewrite /radius -(rmorph0 (real_rmorphism F)) real_lt; apply/Z.ltb_lt/Z.mul_pos_pos; [lia|exact/Z.ltb_lt].
case: (ltnP l N) => lN; last by rewrite /contact_at nth_default ?size_contacts //= ltr01.
have := formed (Lower 0 0) l; rewrite size_contacts => /(_ lN); rewrite /contact_at.
case: (nth _ _ _) => [i j k m m'|i a|i a|k] /=; rewrite ?ltr01 // => /and5P[i_n j_n _ _ _].
by rewrite addr_gt0 ?radius_gt0.
Qed.

Lemma forces_follow_from_residuals (q : 'cV[F]_N) x : vertex_check v -> norm (q - q0) <= rho ->
  b * norm x <= norm ((A q)^T *m x).
Proof.
case/and5P=> _ _ _ _ well; have [_ z0 s0] := positive; apply: transposed_inverse_in_the_ball; last by move=> y; apply: strong.
by rewrite -(real_zero F) real_lt /fine_stiffness; nia.
Qed.

Lemma gaps_follow_displacements (q : 'cV[F]_N) x : vertex_check v -> norm (q - q0) <= rho ->
  A q \in unitmx /\ b * norm x <= norm (A q *m x).
Proof.
case/and5P=> _ _ _ _ well near; have [_ z0 s0] := positive.
have b0 : 0 < b by rewrite -(real_zero F) real_lt /fine_stiffness; nia.
have strong' y := strong y well.
by split; [apply: (regular_in_the_ball b0 strong' near)|apply: (inverse_in_the_ball b0 strong' x near)].
Qed.

Theorem one_vertex : complete F -> vertex_check v -> exists q : 'cV[F]_N,
  [/\ norm (q - q1) <= r, norm (q - q0) <= real (distance v),
     forall l : 'I_N, touch d n radius place (at_ q) (contact_at (contacts v) l),
     normals radius (contacts v) q \in unitmx
   & forall q' : 'cV[F]_N, norm (q' - q0) <= rho ->
       (forall l : 'I_N, touch d n radius place (at_ q') (contact_at (contacts v) l)) -> q' = q].
Proof.
move=> full /and5P[_ closed near step well]; have [w0 z0 s0] := positive.
have w1 : real (fine_weight v) != 0 :> F by rewrite real_eq0 /fine_weight; nia.
have b0 : 0 < b by rewrite -(rmorph0 (real_rmorphism F)) real_lt /fine_stiffness; nia.
have short : 4%:R * C * r <= b.
  by move: step; rewrite -(real_le F) -[Z.mul (Z.mul 4 _) _]/(Z.of_nat 4 * bend v * error v) /bend !rmorphM !real_morphism !real_of_nat -/n -/C -real_times.
have enough : norm (q1 - q0) + 2%:R * r <= rho.
  by apply: le_trans (inside near); rewrite mulr_natl mulr2n addrA ler_add2r near_stored.
have [q [q_near q_ball root regular alone]] := one_configuration_closes_all_contacts b0 (strong^~ well) (small closed)
  short enough full.
have scales l : scale 1 radius (contact_at (contacts v) l) != 0 := lt0r_neq0 (scales_are_positive l).
exists q; split=> //.
- rewrite -(subrKA q1) (le_trans (norm_triangle _ _)) // addrC; apply: le_trans (near_stored near).
  by rewrite ler_add2l.
- exact/(gaps_vanish _ _ _ _ w1).
- exact: (normals_are_regular scales w1).
- by move=> q' near' /(gaps_vanish _ _ _ _ w1); apply: alone.
Qed.
End Correct.
Print Assumptions one_vertex.
