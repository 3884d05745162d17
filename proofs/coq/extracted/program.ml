(* The check that Coq extracted, of the file of integers that Coq would read:  program CERTIFICATE.v

   Prints the data that were checked as Coq prints them, for ../compare.py. *)

let contact_text = function
  | Checker.Image (i, j, k, l, m) -> ("Image", [ i; j; k; l; m ])
  | Checker.Lower (i, a) -> ("Lower", [ i; a ])
  | Checker.Upper (i, a) -> ("Upper", [ i; a ])
  | Checker.Held k -> ("Held", [ k ])

let show value =
  let one kind z = Printf.printf "     = %s\n     : %s\n" (Z.to_string z) kind in
  let many kind text items = Printf.printf "     = [:: %s]\n     : seq %s\n" (String.concat "; " (List.map text items)) kind in
  match value with
  | Checker.Number z -> one "Z" z
  | Checker.Natural k -> one "nat" k
  | Checker.Numbers l -> many "Z" Z.to_string l
  | Checker.Naturals l -> many "nat" Z.to_string l
  | Checker.Flags l -> many "bool" string_of_bool l
  | Checker.Contacts l ->
      many "contact" (fun c -> let kind, numbers = contact_text c in String.concat " " (kind :: List.map Z.to_string numbers)) l

let () =
  Gc.set { (Gc.get ()) with minor_heap_size = 1 lsl 20 }; (* a quarter of the time is spared *)
  let exponents, whole = Reader.certificate Sys.argv.(1) in
  if not (Checker.load_check whole) then (print_endline "the extracted check is false"; exit 1);
  print_endline "the extracted check is true";
  List.iter show (Checker.Numbers exponents :: Checker.statement whole)
